/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splits an XML document into tags, with the text before each. Comments, instructions and the
 * document type are passed over. Entities are the five of XML and numbers; others stay as they are
 * written. Tags are not matched with each other: the readers know which ones they wait for.
 *
 * Example: in "<a x='1'>b&amp;c</a>" the tags are OPEN a with the attribute x, then CLOSE a with
 * the text "b&amp;c" before it, which thr_xml_plain makes "b&c". */
#include "graph/io/read_parts.h"

#include <stdlib.h>
#include <string.h>

/* What begins with < and is no tag, and whether its inside is text. The last one is anything else
 * with an exclamation mark, so the order matters. */
static const struct {
  const char *begin, *end;
  bool text;
} passed[] = {
    {"!--", "-->", false}, {"?", "?>", false}, {"![CDATA[", "]]>", true}, {"!", ">", false}};

thr_status thr_xml_start(thr_xml *xml, const char *text, size_t n, const char *name, thr_err *err)
{
  *xml = (thr_xml){0};
  return thr_scan_start(&xml->scan, text, n, name, err);
}

/* Moves past the next occurrence of a word, counting lines; returns false at the end of the text if
 * there is none. */
static bool pass(thr_xml *xml, const char *word)
{
  const size_t n = strlen(word);

  for (; xml->scan.at < xml->scan.end; xml->scan.at++) {
    if ((size_t)(xml->scan.end - xml->scan.at) >= n && memcmp(xml->scan.at, word, n) == 0) {
      xml->scan.at += n;
      return true;
    }
    xml->scan.next += *xml->scan.at == '\n';
  }

  return false;
}

/* Returns whether the rest of the text begins with a word. */
static bool stands_here(const thr_xml *xml, const char *word)
{
  return thr_span_starts((thr_span){xml->scan.at, (size_t)(xml->scan.end - xml->scan.at)}, word);
}

/* Moves to the end of a tag: a > outside of quotes. */
static thr_status pass_tag(thr_xml *xml, thr_err *err)
{
  for (char quote = '\0'; xml->scan.at < xml->scan.end; xml->scan.at++) {
    const char c = *xml->scan.at;
    xml->scan.next += c == '\n';

    /* Inside of quotes only the same quote counts. */
    if (quote) {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return THR_OK;
    }
  }

  return thr_scan_fail(&xml->scan, err, "a tag is not closed");
}

/* Returns whether a byte is white space. */
static bool is_blank(char c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Reads a tag, whose < has been passed. */
static thr_status read_tag(thr_xml *xml, thr_err *err)
{
  const bool close = stands_here(xml, "/");

  xml->scan.at += close;
  const char *from = xml->scan.at;
  thr_status st = pass_tag(xml, err);
  if (st) return st;

  /* The inside of the tag, without the strokes at its ends. */
  thr_span inside = {from, (size_t)(xml->scan.at++ - from)};
  const bool empty = inside.n && inside.s[inside.n - 1] == '/';
  inside.n -= empty;
  xml->kind = close ? THR_XML_CLOSE : empty ? THR_XML_EMPTY : THR_XML_OPEN;

  /* Its name, without the namespace before a colon, then its attributes. */
  size_t n = 0, colon = 0;
  for (; n < inside.n && !is_blank(inside.s[n]); n++)
    if (inside.s[n] == ':') colon = n + 1;

  xml->name = (thr_span){inside.s + colon, n - colon};
  xml->attributes = (thr_span){inside.s + n, inside.n - n};
  return THR_OK;
}

/* Moves to the next tag; everything else between two tags is its text. */
thr_status thr_xml_next(thr_xml *xml, thr_err *err)
{
  const char *from = xml->scan.at;

  /* Look for a tag, passing over comments and the like. */
  for (;;) {
    if (!pass(xml, "<")) {
      xml->kind = THR_XML_END;
      return THR_OK;
    }

    /* The text begins after the tag before this one, whatever comments are in it. */
    xml->scan.line = xml->scan.next;
    xml->text = (thr_span){from, (size_t)(xml->scan.at - from - 1)};

    /* What is not in the table is a tag. */
    size_t i = 0;
    while (i < sizeof passed / sizeof *passed && !stands_here(xml, passed[i].begin))
      i++;

    if (i == sizeof passed / sizeof *passed) return read_tag(xml, err);
    if (!pass(xml, passed[i].end))
      return thr_scan_fail(&xml->scan, err, "what begins with <%s is not closed", passed[i].begin);
  }
}

/* Appends a character as UTF-8. U+FFFD stands for what is no character. */
static void append_character(thr_text *out, unsigned long code)
{
  /* Surrogates are halves of characters. */
  if (code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) code = 0xfffd;
  if (code < 0x80) {
    thr_text_byte(out, (char)code);
    return;
  }

  /* The first byte has as many leading ones as there are bytes; each further byte has six bits. */
  const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  static const unsigned char lead[] = {0, 0xc0, 0xe0, 0xf0};
  thr_text_byte(out, (char)(lead[more] | code >> 6 * more));

  for (int i = more - 1; i >= 0; i--)
    thr_text_byte(out, (char)(0x80 | (code >> 6 * i & 0x3f)));
}

/* Appends what an entity means, from its & on, and returns how many bytes the entity has; 0 if it
 * is none. */
static size_t append_entity(thr_span rest, thr_text *out)
{
  static const struct {
    const char *name;
    char c;
  } known[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};

  /* The five that have names. */
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_starts(rest, known[i].name)) {
      thr_text_byte(out, known[i].c);
      return strlen(known[i].name);
    }

  /* Numbers: &#65; or &#x41;. */
  char digits[12] = "";
  if (rest.n < 4 || rest.s[1] != '#') return 0;
  const bool hexadecimal = rest.s[2] == 'x';
  const size_t first = hexadecimal ? 3 : 2;
  size_t n = 0;

  while (n < 10 && first + n < rest.n && strchr("0123456789abcdefABCDEF", rest.s[first + n]))
    n++;

  if (n == 0 || n > 8 || first + n >= rest.n || rest.s[first + n] != ';') return 0;
  memcpy(digits, rest.s + first, n);
  append_character(out, strtoul(digits, NULL, hexadecimal ? 16 : 10));

  return first + n + 1;
}

/* Appends what a section that is no tag means: CDATA as they are written, comments and instructions
 * not at all. Returns how many bytes the section has; 0 if it is none. */
static size_t append_section(thr_span rest, thr_text *out)
{
  for (size_t i = 0; i < sizeof passed / sizeof *passed; i++) {
    /* The < before it has been seen. */
    const size_t begin = 1 + strlen(passed[i].begin), end = strlen(passed[i].end);
    if (rest.n < begin + end ||
        !thr_span_starts((thr_span){rest.s + 1, rest.n - 1}, passed[i].begin))
      continue;

    /* Look for its end. */
    size_t n = begin;
    while (n + end <= rest.n && memcmp(rest.s + n, passed[i].end, end) != 0)
      n++;
    if (n + end > rest.n) return 0;
    if (passed[i].text) thr_text_append_bytes(out, rest.s + begin, n - begin);
    return n + end;
  }

  return 0;
}

/* Copies a text byte by byte, but for entities and sections. */
void thr_xml_plain(thr_span text, thr_text *out)
{
  /* Even without a letter the text is not NULL. */
  thr_text_append(out, "");

  /* What is no entity and no section stays as it is written. */
  for (size_t i = 0; i < text.n;) {
    const thr_span rest = {text.s + i, text.n - i};
    const size_t taken = text.s[i] == '&'   ? append_entity(rest, out)
                         : text.s[i] == '<' ? append_section(rest, out)
                                            : 0;
    if (!taken) thr_text_byte(out, text.s[i]);
    i += taken ? taken : 1;
  }
}

/* Goes through the attributes of the tag in turn. */
bool thr_xml_attribute(const thr_xml *xml, const char *name, thr_text *out)
{
  const thr_span all = xml->attributes;
  size_t at = 0;

  out->length = 0;

  /* An attribute is a name, =, and a value in either kind of quotes. */
  for (;;) {
    while (at < all.n && is_blank(all.s[at]))
      at++;

    const size_t from = at;
    while (at < all.n && all.s[at] != '=' && !is_blank(all.s[at]))
      at++;

    const thr_span key = {all.s + from, at - from};
    while (at < all.n && (is_blank(all.s[at]) || all.s[at] == '='))
      at++;

    /* Anything else ends the list. */
    if (at >= all.n || (all.s[at] != '"' && all.s[at] != '\'')) return false;
    const char quote = all.s[at++];
    const size_t value = at;

    while (at < all.n && all.s[at] != quote)
      at++;

    /* The value's entities are resolved only now that it is wanted. */
    if (thr_span_is(key, name)) {
      thr_xml_plain((thr_span){all.s + value, at - value}, out);
      return true;
    }

    at++;
  }
}
