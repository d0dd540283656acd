/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a PDF 1.4 (ISO 32000-1) that grows page by page.
 *
 * Each page's content stream is compressed and appended as soon as it is added, so that pages need
 * not be kept. What pages share (fonts, opacities) is written at the end, when it is known which
 * letters were used. Objects 1 to 4 have fixed numbers, so that pages can refer to what comes
 * later; the table at the end says at which byte each object begins.
 *
 * Fonts are composite ones (9.7) whose codes are Unicode numbers of 16 bits: CIDToGIDMap leads from
 * the code to the glyph, ToUnicode from the code to the letter that a search finds. Only glyphs
 * that are used have outlines in the embedded file.
 *
 * Example: a booklet of two pages in one face has objects 1 catalog, 2 pages, 3 info, 4 resources,
 * 5 and 6 drawings, 7 and 8 feet, 9 to 14 the font, 15 and 16 the pages. */
#include "diagram/export/export_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of the objects that every file has. */
enum { CATALOG = 1, PAGES, INFO, RESOURCES, FIRST_FREE };

static const double POINT = 25.4 / 72; /* mm */

/* A page: its drawing and what was added to it later, such as the foot. */
typedef struct {
  int content[2]; /* numbers of the stream objects; 0 = none */
} pdf_page;

struct thr_pdf {
  thr_text out;
  thr_font font[THR_FACES];
  thr_paper_needs needs; /* of all pages */
  char title[128];
  double size[2]; /* mm */
  int n_objects, objects_capacity;
  size_t *object; /* [n_objects] byte at which object i begins; there is no object 0 */
  int n_pages, pages_capacity;
  pdf_page *page;
};

thr_status thr_pdf_open(thr_pdf **out, thr_page_size size, const char *title, thr_err *err)
{
  thr_pdf *pdf = *out = thr_calloc(1, sizeof *pdf);
  if (!pdf) return thr_nomem(err);

  thr_page_mm(size, pdf->size);
  thr_text_copy_clean(pdf->title, sizeof pdf->title, title);

  /* Four bytes above 127 tell programs that the file is binary (7.5.2). */
  thr_text_append_bytes(&pdf->out, "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", 15);

  thr_status st = thr_deflate_load(err);
  if (!st) st = thr_fonts_find(pdf->font, err);

  /* The fixed objects get their places later. */
  for (int i = 0; i < FIRST_FREE && !st; i++) {
    st = thr_grow(&pdf->object, pdf->n_objects, &pdf->objects_capacity, sizeof *pdf->object, err);
    if (!st) pdf->object[pdf->n_objects++] = 0;
  }
  return st;
}

void thr_pdf_destroy(thr_pdf *pdf)
{
  if (!pdf) return;

  /* Fonts, and the sets of letters that were needed of them. */
  for (int i = 0; i < THR_FACES; i++) {
    thr_font_destroy(&pdf->font[i]);
    free(pdf->needs.letter[i]);
  }

  thr_text_destroy(&pdf->out);
  free(pdf->object);
  free(pdf->page);
  free(pdf);
}

/* ---- objects ---- */

/* Begins an object whose number is fixed, at the end of the file so far. */
static void begin(thr_pdf *pdf, int object)
{
  pdf->object[object] = pdf->out.length;
  thr_text_printf(&pdf->out, "%d 0 obj\n", object);
}

/* Begins an object with the next number. Returns the number, or 0 if memory ran out. */
static int begin_new(thr_pdf *pdf)
{
  if (thr_grow(&pdf->object, pdf->n_objects, &pdf->objects_capacity, sizeof *pdf->object, NULL)) {
    pdf->out.failed = true;
    return 0;
  }
  begin(pdf, pdf->n_objects);
  return pdf->n_objects++;
}

/* Ends the object. */
static void end(thr_pdf *pdf)
{
  thr_text_append(&pdf->out, "\nendobj\n");
}

/* Appends a stream of compressed bytes as an object. more: further entries of the stream's
 * dictionary. Returns the object's number, or 0 if memory ran out. */
static int put_stream(thr_pdf *pdf, const thr_text *small, const char *more)
{
  int object = begin_new(pdf);
  if (!object) return 0;

  /* A stream is a dictionary with the number of bytes, and the bytes. */
  thr_text_printf(&pdf->out, "<</Length %zu/Filter/FlateDecode%s>>\nstream\n", small->length, more);

  if (small->length) thr_text_append_bytes(&pdf->out, small->data, small->length);

  thr_text_append(&pdf->out, "\nendstream");
  end(pdf);
  return pdf->out.failed ? 0 : object;
}

/* Compresses bytes into a stream object and releases them. Returns the object's number; *st
 * receives failures. */
static int put_bytes(thr_pdf *pdf, thr_text *bytes, const char *more, thr_err *err, thr_status *st)
{
  thr_text small = {0};
  *st = bytes->failed ? thr_nomem(err)
                      : thr_deflate(bytes->data, bytes->length, THR_DEFLATE_FAST, &small, err);
  int object = *st ? 0 : put_stream(pdf, &small, more);

  thr_text_destroy(bytes);
  thr_text_destroy(&small);
  return object;
}

/* ---- pages ---- */

thr_status thr_leaf_open(thr_leaf *leaf, const thr_pdf *pdf, thr_err *err)
{
  *leaf = (thr_leaf){0};
  return thr_paper_open(&leaf->paper, pdf->size, pdf->font, err);
}

thr_status thr_leaf_squeeze(thr_leaf *leaf, thr_err *err)
{
  const thr_text *content;
  thr_status st = thr_paper_content(leaf->paper, &content, err);
  return st ? st : thr_deflate(content->data, content->length, THR_DEFLATE_FAST, &leaf->small, err);
}

void thr_leaf_destroy(thr_leaf *leaf)
{
  thr_paper_destroy(leaf->paper);
  thr_text_destroy(&leaf->small);
  *leaf = (thr_leaf){0};
}

/* Adds what a page needs of fonts and opacities to what all pages need. */
static thr_status add_needs(thr_paper_needs *all, const thr_paper_needs *more, thr_err *err)
{
  enum { BYTES = THR_FONT_LETTERS / 8 };

  /* Opacities are numbered by hundredths. */
  for (int i = 0; i < THR_OPACITIES; i++) {
    all->fill[i] |= more->fill[i];
    all->stroke[i] |= more->stroke[i];
  }

  for (int face = 0; face < THR_FACES; face++) {
    /* A bit for every letter of the basic plane. */
    if (!more->letter[face]) continue;
    if (!all->letter[face]) all->letter[face] = thr_calloc(BYTES, 1);
    if (!all->letter[face]) return thr_nomem(err);
    for (int i = 0; i < BYTES; i++)
      all->letter[face][i] |= more->letter[face][i];
  }
  return THR_OK;
}

thr_status thr_pdf_add(thr_pdf *pdf, int nth, const thr_leaf *leaf, thr_err *err)
{
  thr_status st = add_needs(&pdf->needs, thr_paper_needs_of(leaf->paper), err);
  if (!st && nth < 0)
    st = thr_grow(&pdf->page, pdf->n_pages, &pdf->pages_capacity, sizeof *pdf->page, err);

  if (st) return st;

  /* The page's drawing is in the file from here on; only its number is kept. */
  int object = put_stream(pdf, &leaf->small, "");
  if (!object) return thr_nomem(err);

  /* A page shows its streams one after the other. */
  if (nth < 0)
    pdf->page[pdf->n_pages++] = (pdf_page){.content = {object, 0}};
  else
    pdf->page[nth].content[1] = object;
  return THR_OK;
}

/* Writes the page tree (7.7.3): one node whose kids are all pages, in the order in which they are
 * read. Page size and resources are inherited from this node. */
static void put_pages(thr_pdf *pdf, bool last_first)
{
  thr_text kids = {0};
  for (int k = 0; k < pdf->n_pages; k++) {
    /* The page that was added last may come first: 0, 1, 2 become 2, 0, 1. */
    const pdf_page *this_page = &pdf->page[!last_first ? k : k ? k - 1 : pdf->n_pages - 1];

    /* The dictionary of a page names its parent and its one or two streams. */
    int object = begin_new(pdf);
    thr_text_printf(&kids, "%d 0 R\n", object);
    thr_text_printf(&pdf->out, "<</Type/Page/Parent %d 0 R/Contents[%d 0 R", PAGES,
                    this_page->content[0]);
    if (this_page->content[1]) thr_text_printf(&pdf->out, " %d 0 R", this_page->content[1]);

    thr_text_append(&pdf->out, "]>>");
    end(pdf);
  }

  /* The node itself. */
  begin(pdf, PAGES);
  thr_text_printf(&pdf->out,
                  "<</Type/Pages/Count %d/MediaBox[0 0 %.6f %.6f]/Resources %d 0 R/Kids[\n",
                  pdf->n_pages, pdf->size[0] / POINT, pdf->size[1] / POINT, RESOURCES);

  if (kids.failed) pdf->out.failed = true;
  if (kids.length) thr_text_append_bytes(&pdf->out, kids.data, kids.length);
  thr_text_append(&pdf->out, "]>>");
  end(pdf);

  thr_text_destroy(&kids);
}

/* ---- fonts: composite ones whose codes are the letters themselves (ISO 32000-1, 9.7) ---- */

/* Returns whether a letter's bit is set. */
static bool is_set(const unsigned char *letters, int letter)
{
  return letters[letter / 8] >> letter % 8 & 1;
}

/* Writes the font file with the glyphs of the needed letters. Returns the object's number; *st
 * receives failures. */
static int put_file(thr_pdf *pdf, const thr_font *font, const unsigned char *letters, thr_err *err,
                    thr_status *st)
{
  thr_text part = {0};
  char more[40];
  unsigned char *used = thr_calloc((size_t)font->n_glyphs, 1);

  *st = used ? THR_OK : thr_nomem(err);

  /* From letters to glyphs. */
  for (int letter = 0; letter < THR_FONT_LETTERS && used; letter++)
    if (is_set(letters, letter)) used[font->glyph[letter]] = 1;

  /* Only their outlines. A PDF must say how long the font is when it is not compressed. */
  if (!*st) *st = thr_font_subset(font, used, &part, err);
  snprintf(more, sizeof more, "/Length1 %zu", part.length);

  free(used);
  if (!*st) return put_bytes(pdf, &part, more, err, st);
  thr_text_destroy(&part);
  return 0;
}

/* Writes CIDToGIDMap: the glyph of each code, two bytes, the higher first. 128 KiB, nearly all of
 * them zeros, which compress well. Returns the object's number. */
static int put_glyphs(thr_pdf *pdf, const thr_font *font, const unsigned char *letters,
                      thr_err *err, thr_status *st)
{
  thr_text map = {0};

  /* A code that is not used leads to glyph 0. */
  for (int letter = 0; letter < THR_FONT_LETTERS; letter++) {
    int glyph = is_set(letters, letter) ? font->glyph[letter] : 0;
    thr_text_byte(&map, (char)(glyph >> 8));
    thr_text_byte(&map, (char)(glyph & 255));
  }

  /* The map is as long as the basic plane, whatever is used of it. */
  return put_bytes(pdf, &map, "", err, st);
}

/* Writes ToUnicode (9.10.3): each code is found as the letter itself. Returns the object's
 * number. */
static int put_words(thr_pdf *pdf, const unsigned char *letters, thr_err *err, thr_status *st)
{
  enum { MOST = 100 }; /* in one list */
  thr_text map = {0}, list = {0};
  int n = 0;

  /* The frame of a CMap, which is a small PostScript program. */
  thr_text_append(&map, "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CMapName "
                        "/Letters def\n/CMapType 2 def\n"
                        "1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n");

  /* Lists of up to MOST letters, as a CMap wants them; one step beyond the last letter ends the
   * last list. */
  for (int letter = 0; letter <= THR_FONT_LETTERS; letter++) {
    bool here = letter < THR_FONT_LETTERS && is_set(letters, letter);
    if (here) thr_text_printf(&list, "<%04X> <%04X>\n", (unsigned)letter, (unsigned)letter);

    n += here;
    if (!n || (n < MOST && letter < THR_FONT_LETTERS)) continue;

    thr_text_printf(&map, "%d beginbfchar\n%sendbfchar\n", n, list.failed ? "" : list.data);
    list.length = 0;
    n = 0;
  }

  thr_text_append(&map, "endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n");
  map.failed |= list.failed;
  thr_text_destroy(&list);
  return put_bytes(pdf, &map, "", err, st);
}

/* Appends the name of a font of which only a part is embedded: six capital letters, a different one
 * first for each face, and a plus sign (9.6.4). */
static void put_name(thr_pdf *pdf, const thr_font *font, int face)
{
  thr_text_printf(&pdf->out, "/%cTHREA+%s", 'A' + face, font->name);
}

/* Writes what describes a font (9.8): lengths in thousandths of an em. Returns the object's
 * number. */
static int put_descriptor(thr_pdf *pdf, const thr_font *font, int face, int file)
{
  enum { FIXED = 1, SYMBOLIC = 4 };
  double em = 1000.0 / font->units;

  /* em turns units of the font file into thousandths of an em. */
  int object = begin_new(pdf);
  thr_text_append(&pdf->out, "<</Type/FontDescriptor/FontName");
  put_name(pdf, font, face);

  /* Symbolic, as codes are no standard encoding. Height of capitals and width of stems are
   * estimates, used only where the font cannot be. */
  thr_text_printf(&pdf->out,
                  "/Flags %d/FontBBox[%.0f %.0f %.0f %.0f]/ItalicAngle 0/Ascent %.0f/Descent "
                  "%.0f/CapHeight %.0f/StemV %d",
                  SYMBOLIC + (face & THR_FACE_MONO ? FIXED : 0), font->box[0] * em,
                  font->box[1] * em, font->box[2] * em, font->box[3] * em, font->ascent * em,
                  font->descent * em, 0.75 * font->ascent * em, face & THR_FACE_BOLD ? 140 : 80);

  thr_text_printf(&pdf->out, "/FontFile2 %d 0 R>>", file);
  end(pdf);
  return object;
}

/* Writes a face of which letters are needed: file, two maps, descriptor, and the two dictionaries
 * of a composite font. Returns the object's number. */
static int put_font(thr_pdf *pdf, int face, thr_err *err, thr_status *st)
{
  const thr_font *font = &pdf->font[face];
  const unsigned char *letters = pdf->needs.letter[face];

  /* Streams first: an object cannot stand inside another one. */
  int file = put_file(pdf, font, letters, err, st),
      glyphs = *st ? 0 : put_glyphs(pdf, font, letters, err, st),
      words = *st ? 0 : put_words(pdf, letters, err, st);

  if (*st) return 0;

  /* The descendant font has the widths of all letters used. */
  int descriptor = put_descriptor(pdf, font, face, file), below = begin_new(pdf);
  thr_text_append(&pdf->out, "<</Type/Font/Subtype/CIDFontType2/BaseFont");
  put_name(pdf, font, face);
  thr_text_printf(&pdf->out,
                  "/CIDSystemInfo<</Registry(Adobe)/Ordering(Identity)/Supplement "
                  "0>>/FontDescriptor %d 0 R/CIDToGIDMap %d 0 R/W[",
                  descriptor, glyphs);

  for (int letter = 0; letter < THR_FONT_LETTERS; letter++)
    if (is_set(letters, letter))
      thr_text_printf(&pdf->out, "%d[%.3f]\n", letter,
                      1000 * thr_font_advance(font, font->glyph[letter]));

  thr_text_append(&pdf->out, "]>>");
  end(pdf);

  /* The font that pages name refers to it. */
  int object = begin_new(pdf);
  thr_text_append(&pdf->out, "<</Type/Font/Subtype/Type0/BaseFont");
  put_name(pdf, font, face);
  thr_text_printf(&pdf->out, "/Encoding/Identity-H/DescendantFonts[%d 0 R]/ToUnicode %d 0 R>>",
                  below, words);

  end(pdf);
  return object;
}

/* ---- the end ---- */

/* Writes what pages share: fonts /F0 .. and graphics states /f0 .. /s100 for opacities. */
static thr_status put_resources(thr_pdf *pdf, thr_err *err)
{
  int font[THR_FACES] = {0};
  thr_status st = THR_OK;

  /* Fonts are objects of their own, and so come before this one. */
  for (int i = 0; i < THR_FACES && !st; i++)
    if (pdf->needs.letter[i]) font[i] = put_font(pdf, i, err, &st);

  /* The dictionary that the page tree hands down to all pages. */
  begin(pdf, RESOURCES);
  thr_text_append(&pdf->out, "<</Font<<");
  for (int i = 0; i < THR_FACES; i++)
    if (font[i]) thr_text_printf(&pdf->out, "/F%d %d 0 R", i, font[i]);

  /* /f40 fills with an opacity of 0.40, /s40 draws lines with it. */
  thr_text_append(&pdf->out, ">>/ExtGState<<");
  for (int i = 0; i < THR_OPACITIES; i++) {
    if (pdf->needs.fill[i]) thr_text_printf(&pdf->out, "/f%d<</ca %.2f>>", i, i / 100.0);
    if (pdf->needs.stroke[i]) thr_text_printf(&pdf->out, "/s%d<</CA %.2f>>", i, i / 100.0);
  }
  thr_text_append(&pdf->out, ">>>>");

  end(pdf);
  return st;
}

/* Writes the metadata: the title as UTF-16 in hexadecimal digits, and one fixed date, so that the
 * same plan gives the same bytes. */
static void put_info(thr_pdf *pdf)
{
  static const char epoch[] = "(D:20000101000000Z)";

  begin(pdf, INFO);

  /* FEFF says UTF-16; a title is ASCII. */
  thr_text_append(&pdf->out, "<</Title<FEFF");
  for (const char *c = pdf->title; *c; c++)
    thr_text_printf(&pdf->out, "%04X",
                    (unsigned char)*c < 0x80 ? (unsigned)(unsigned char)*c : '?');

  thr_text_printf(&pdf->out, ">/CreationDate%s/ModDate%s>>", epoch, epoch);
  end(pdf);
}

thr_status thr_pdf_close(thr_pdf *pdf, bool last_first, thr_text *out, thr_err *err)
{
  thr_status st = put_resources(pdf, err);

  if (st) return st;

  /* What was announced by a fixed number. */
  put_pages(pdf, last_first);
  put_info(pdf);

  begin(pdf, CATALOG);
  thr_text_printf(&pdf->out, "<</Type/Catalog/Pages %d 0 R>>", PAGES);
  end(pdf);

  /* The cross-reference table (7.5.4): an entry of 20 bytes for every object. */
  size_t table = pdf->out.length;
  thr_text_printf(&pdf->out, "xref\n0 %d\n0000000000 65535 f \n", pdf->n_objects);

  for (int i = 1; i < pdf->n_objects; i++)
    thr_text_printf(&pdf->out, "%010zu 00000 n \n", pdf->object[i]);

  thr_text_printf(&pdf->out,
                  "trailer\n<</Size %d/Root %d 0 R/Info %d 0 R>>\nstartxref\n%zu\n%%%%EOF\n",
                  pdf->n_objects, CATALOG, INFO, table);

  if (pdf->out.failed) return thr_nomem(err);

  /* An empty out takes the bytes over instead of a copy. */
  if (!out->length && !out->failed) {
    thr_text_destroy(out);
    *out = pdf->out;
    pdf->out = (thr_text){0};
  } else
    thr_text_append_bytes(out, pdf->out.data, pdf->out.length);
  return out->failed ? thr_nomem(err) : THR_OK;
}
