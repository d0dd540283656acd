/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pages drawn from SVG: the pixels are those that librsvg draws (rsvg-convert), the words those of
 * the document, and what the reader does not know is refused. */
#define _POSIX_C_SOURCE 200809L
#include "diagram/export/export_parts.h"
#include "diagram/export/paper.h"
#include "diagram/sheets/sheets.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/text.h"
#include "tests/sample_plans.h"
#include "tests/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const thr_limits none;

#define HEAD                                                                                       \
  "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "         \
  "class=\"thread\" width=\"210mm\" "                                                              \
  "height=\"297mm\" viewBox=\"0 0 210 297\">"

/* ---- pictures ---- */

static thr_text pdf_of(const thr_text *svg)
{
  thr_text out = {0};
  thr_err err = {0};
  thr_pages *pages = NULL;
  thr_text page = {0};
  thr_text_append_bytes(&page, svg->data, svg->length);
  ck_assert_msg(!thr_pages_open(&pages, "page", THR_PAGE_A4, "A page", &none, &err), "%s",
                err.text);
  ck_assert_msg(!thr_pages_add(pages, -1, &page, &err), "%s", err.text);
  ck_assert_msg(!thr_pages_close(pages, false, &out, &err), "%s", err.text);
  thr_pages_destroy(pages);
  return out;
}

/* What a command says of a file that holds these bytes. */
static thr_text told_by(const char *before, const char *after, const thr_text *bytes)
{
  char path[] = "/tmp/test_svg_page_XXXXXX", command[160], part[4096];
  int file = mkstemp(path);
  ck_assert(file >= 0 && write(file, bytes->data, bytes->length) == (ssize_t)bytes->length);
  close(file);
  snprintf(command, sizeof command, "%s %s %s", before, path, after);
  FILE *told = popen(command, "r");
  ck_assert_ptr_nonnull(told);
  thr_text text = {0};
  for (size_t n; (n = fread(part, 1, sizeof part, told)) > 0;)
    thr_text_append_bytes(&text, part, n);
  ck_assert_int_eq(pclose(told), 0);
  unlink(path);
  return text;
}

/* How far two pictures (PPM of one page) are apart: the mean over all pixels and colours, and the
 * most of any, of 255. */
typedef struct {
  double mean;
  int most;
} distance;

static distance distance_of(const thr_text *a, const thr_text *b)
{
  distance d = {0};
  int width, height, start = 0;
  ck_assert_int_eq(sscanf(a->data, "P6 %d %d 255%n", &width, &height, &start), 2);
  ck_assert(start > 0 && a->length == b->length && memcmp(a->data, b->data, (size_t)start) == 0);
  ck_assert_uint_eq(a->length, (size_t)start + 1 + 3 * (size_t)width * (size_t)height);
  for (size_t i = (size_t)start; i < a->length; i++) {
    int apart = abs((int)(unsigned char)a->data[i] - (int)(unsigned char)b->data[i]);
    d.mean += apart / (double)(a->length - (size_t)start);
    d.most = apart > d.most ? apart : d.most;
  }
  return d;
}

/* Ours and librsvg's, at so many dots per inch. */
static distance apart(const thr_text *svg, int dpi)
{
  char rsvg[64], ours[64];
  snprintf(rsvg, sizeof rsvg, "| pdftoppm -r %d -", dpi);
  snprintf(ours, sizeof ours, "pdftoppm -r %d", dpi);
  thr_text pdf = pdf_of(svg), a = told_by(ours, "", &pdf),
           b = told_by("rsvg-convert -f pdf", rsvg, svg);
  distance d = distance_of(&a, &b);
  thr_text_destroy(&pdf);
  thr_text_destroy(&a);
  thr_text_destroy(&b);
  return d;
}

/* No letters: nothing but the rounding of what is half inside a pixel may differ. */
static const char *const pictures[] = {
    /* the strength of selectors, their order, inheritance, style=".." above all */
    "<style>.thread .a{fill:#00f}.thread rect{fill:#f00}.thread .a.b{fill:#0f0}.thread .g "
    ".a{stroke:#123456;stroke-width:3}"
    ".thread .p{stroke:#111;stroke-width:4}.thread "
    ".p:not([stroke-dasharray]){stroke-linecap:round}</style>"
    "<rect x=\"10\" y=\"10\" width=\"40\" height=\"30\"/><rect class=\"a\" x=\"60\" y=\"10\" "
    "width=\"40\" height=\"30\"/>"
    "<rect class=\"b a\" x=\"110\" y=\"10\" width=\"40\" height=\"30\" fill=\"#fff\"/>"
    "<g class=\"g\" fill=\"#abc\"><g><rect class=\"a\" x=\"10\" y=\"60\" width=\"40\" "
    "height=\"30\" style=\"fill:#ff0\"/></g>"
    "<circle cx=\"100\" cy=\"80\" r=\"22\"/></g>"
    "<path class=\"p\" d=\"M10 120L190 130\"/><path class=\"p\" stroke-dasharray=\"9 7\" d=\"M10 "
    "150L190 160\"/>",
    /* paths: all commands, several in one, holes, corners */
    "<path d=\"M10 10H90V60H10zm10 10v30h60v-30z\" fill=\"#269\"/>"
    "<path fill=\"none\" stroke=\"#c40\" stroke-width=\"5\" d=\"M20 100C20 200 120 60 120 160c0 40 "
    "40 40 60 0l5 -60\"/>"
    "<path fill=\"none\" stroke=\"#000\" stroke-width=\"6\" d=\"M20 220 60 280 100 220 104 280\"/>"
    "<path fill=\"none\" stroke=\"#000\" stroke-width=\"6\" stroke-linejoin=\"round\" d=\"M120 "
    "220L160 280L170 220\"/>",
    /* rounded corners, opacity, order of painting, shifts inside clipping */
    "<clipPath id=\"c-0\"><rect x=\"20\" y=\"20\" width=\"80\" height=\"90\"/></clipPath>"
    "<g clip-path=\"url(#c-0)\"><g transform=\"translate(-30 10)\"><g transform=\"translate(60 "
    "-5.5)\">"
    "<rect x=\"0\" y=\"0\" width=\"200\" height=\"50\" rx=\"12\" fill=\"#393\"/></g>"
    "<rect x=\"10\" y=\"70\" width=\"90\" height=\"60\" rx=\"30\" fill=\"#f80\" stroke=\"#000\" "
    "stroke-width=\"2\"/></g></g>"
    "<rect x=\"120\" y=\"20\" width=\"60\" height=\"60\" fill=\"#00f\" stroke=\"#f00\" "
    "stroke-width=\"12\" "
    "style=\"paint-order:stroke\"/>"
    "<rect x=\"120\" y=\"120\" width=\"60\" height=\"60\" fill=\"#00f\" fill-opacity=\"0.4\" "
    "stroke=\"#f00\" "
    "stroke-opacity=\"0.5\" "
    "stroke-width=\"12\" stroke-dasharray=\"20 6 8 6\" stroke-dashoffset=\"9\"/>",
    /* what lies wholly outside of a clipping path is left out, and nothing that reaches into it: by
     * the width of its line, by its corner, turned, after a shift, in one clipped again; after the
     * group all is drawn */
    "<clipPath id=\"one\"><rect x=\"50\" y=\"50\" width=\"100\" height=\"100\"/></clipPath>"
    "<clipPath id=\"two\"><rect x=\"0\" y=\"0\" width=\"60\" height=\"60\"/></clipPath>"
    "<g clip-path=\"url(#one)\" fill=\"#07a\" stroke=\"#c00\" stroke-width=\"10\">"
    "<rect x=\"10\" y=\"60\" width=\"36\" height=\"20\"/><rect x=\"10\" y=\"90\" width=\"34\" "
    "height=\"20\"/>"
    "<path fill=\"none\" d=\"M60 25L69 38L78 25\"/><path fill=\"none\" d=\"M156 70H170\"/><circle "
    "cx=\"100\" cy=\"165\" "
    "r=\"12\"/>"
    "<rect x=\"20\" y=\"-8\" width=\"90\" height=\"16\" transform=\"translate(160 100) "
    "rotate(120)\"/>"
    "<g transform=\"translate(70 70)\" clip-path=\"url(#two)\"><circle cx=\"70\" cy=\"30\" "
    "r=\"9\"/><circle cx=\"-20\" "
    "cy=\"-20\" "
    "r=\"15\"/><circle cx=\"200\" cy=\"30\" r=\"30\"/></g><circle cx=\"140\" cy=\"140\" "
    "r=\"4\"/></g>"
    "<rect x=\"20\" y=\"200\" width=\"30\" height=\"30\"/><path d=\"M160 20h30v20z\"/>",
    /* of lines that go out and come in again what is outside is left out: corners, curves, several
     * in one, and not of filled, closed or dashed ones */
    "<clipPath id=\"one\"><rect x=\"50\" y=\"50\" width=\"100\" height=\"100\"/></clipPath>"
    "<g clip-path=\"url(#one)\" fill=\"none\" stroke=\"#07a\" stroke-width=\"6\"><path d=\"M60 "
    "10L60 20L70 90L20 100L10 30L30 "
    "5L120 44L47 "
    "130L20 190L100 190L100 160L110 100C110 20 140 20 140 100C140 200 160 200 190 160L200 60L120 "
    "70\"/>"
    "<path stroke=\"#c40\" d=\"M10 140H60M20 10H90M90 148H200\"/><path fill=\"#9c9\" d=\"M130 "
    "20L190 60L100 60\"/>"
    "<path stroke-dasharray=\"9 5\" d=\"M55 20H20V200H75V90\"/><path d=\"M160 130L190 190L20 "
    "170z\"/></g>"};

enum { N_PICTURES = sizeof pictures / sizeof *pictures };

START_TEST(pictures_are_those_of_librsvg)
{
  thr_text svg = {0};
  thr_text_printf(&svg, "%s%s</svg>\n", HEAD, pictures[_i]);
  svg.length -= strlen("</svg>\n");
  thr_text_append(&svg, "<text x=\"5\" y=\"290\" font-family=\"'DejaVu Sans',sans-serif\" "
                        "font-size=\"5\">x</text></svg>\n");
  distance d = apart(&svg, 25);
  ck_assert_msg(d.mean < 0.15 && d.most <= 60, "mean %.3f, most %d of 255", d.mean, d.most);
  thr_text_destroy(&svg);
}
END_TEST

/* In letters pairs are set closer by librsvg, so that the ends of lines are some tenths of a mm
 * apart; and a thousandth of a mm decides into which row of pixels a thin line is put: few pixels
 * may be far apart. */
START_TEST(sheets_are_those_of_librsvg)
{
  static const int numbers[] = {0, 2, 5};
  thr_plan p = plan_number(numbers[_i]);
  thr_sheets_options o = thr_sheets_options_default();
  thr_sheets *s;
  ck_assert_int_eq(thr_sheets_make(&s, &p, &o, &none, NULL), THR_OK);
  for (int i = 0; i < thr_sheets_pages(s); i++) {
    thr_text svg = {0};
    ck_assert_int_eq(thr_sheets_svg(s, i, &svg, NULL), THR_OK);
    distance d = apart(&svg, 12);
    ck_assert_msg(d.mean < 2 && d.most <= 200, "page %d: mean %.3f, most %d of 255", i + 1, d.mean,
                  d.most);
    thr_text_destroy(&svg);
  }
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(words_are_found_as_they_are_written)
{
  thr_text svg = {0};
  thr_text_append(
      &svg, HEAD
      "<style>.thread text{font-family:'DejaVu Sans',sans-serif}.thread .e{text-anchor:end}</style>"
      "<text x=\"100\" y=\"20\" font-size=\"5\">a &lt; b &amp;amp; &quot;c&quot; "
      "&apos;d&apos;</text>"
      "<text class=\"e\" x=\"100\" y=\"40\" font-size=\"5\">\xC2\xB5 \xE2\x89\xA4 20 "
      "\xE2\x88\x86</text>"
      "<text x=\"100\" y=\"60\" font-size=\"5\" text-anchor=\"middle\" "
      "font-weight=\"bold\">middle</text>"
      "<text x=\"100\" y=\"80\" font-size=\"5\"></text></svg>");
  thr_text pdf = pdf_of(&svg), words = told_by("pdftotext -raw", "-", &pdf),
           boxes = told_by("pdftotext -bbox", "-", &pdf);
  ck_assert_str_eq(words.data,
                   "a < b &amp; \"c\" 'd'\n\xC2\xB5 \xE2\x89\xA4 20 \xE2\x88\x86\nmiddle\n\f");
  const double point = 72 / 25.4;
  double x[2];
  ck_assert_int_eq(sscanf(strstr(boxes.data, "<word"), "<word xMin=\"%lf\"", &x[0]), 1);
  ck_assert_double_eq_tol(x[0], 100 * point, 0.5);
  const char *middle = strstr(boxes.data, ">middle<");
  while (*middle != '<' || strncmp(middle, "<word", 5) != 0)
    middle--;
  ck_assert_int_eq(sscanf(middle, "<word xMin=\"%lf\" yMin=\"%*f\" xMax=\"%lf\"", &x[0], &x[1]), 2);
  ck_assert_double_eq_tol(0.5 * (x[0] + x[1]), 100 * point, 0.5);
  thr_text_destroy(&svg);
  thr_text_destroy(&pdf);
  thr_text_destroy(&words);
  thr_text_destroy(&boxes);
}
END_TEST

/* ---- what is refused ---- */

static const char *const refused[][2] = {
    {"<ellipse cx=\"1\" cy=\"1\" rx=\"1\" ry=\"2\"/>", "'ellipse'"},
    {"<rect x=\"1\" y=\"1\" width=\"1\" height=\"2\" ry=\"1\"/>", "'ry'"},
    {"<rect x=\"1\" y=\"1mm\" width=\"1\" height=\"2\"/>", "'1mm'"},
    {"<rect width=\"9\" height=\"4\" rx=\"3\"/>", "'rect'"},
    {"<path d=\"M1 1A1 1 0 0 1 2 2\"/>", "the path"},
    {"<path d=\"1 1\"/>", "the path"},
    {"<path d=\"M1\"/>", "the path"},
    {"<path/>", "without d"},
    {"<path d=\"M1 1\" fill=\"red\"/>", "fill 'red'"},
    {"<path d=\"M1 1\" fill=\"#12345g\"/>", "fill"},
    {"<path d=\"M1 1\" stroke-linecap=\"square\"/>", "'square'"},
    {"<path d=\"M1 1\" stroke-dasharray=\"1 2 3 4 5\"/>", "stroke-dasharray"},
    {"<path d=\"M1 1\" style=\"opacity:1\"/>", "'opacity'"},
    {"<path d=\"M1 1\" opacity=\"0.5\"/>", "'opacity'"},
    {"<style>.a>.b{fill:#fff}</style>", "'.a>.b'"},
    {"<style>.a{blend:none}</style>", "'blend'"},
    {"<style>.a .b .c .d .e{fill:#fff}</style>", "selector"},
    {"<style>{fill:#fff}</style>", "selector"},
    {"<g transform=\"rotate(3)\"></g>", "'rotate(3)'"},
    {"<g clip-path=\"url(#none)\"></g>", "'url(#none)'"},
    {"<clipPath id=\"a\"><circle cx=\"1\" cy=\"1\" r=\"1\"/></clipPath>", "'circle'"},
    {"<text x=\"1\" y=\"1\"><tspan>a</tspan></text>", "'tspan'"},
    {"<text x=\"1\" y=\"1\" stroke=\"#fff\">a</text>", "a border"},
    {"<text x=\"1\" y=\"1\">&nbsp;</text>", "'&nbsp;'"},
    {"words", "'words'"},
    {"<g>", "'svg'"},
    {"</g>", "'g'"},
    {"<g", "the "},
    {"<path d=\"M1 1", "the "},
};

/* Nothing of it has letters. */
static const thr_font no_fonts[THR_FACES];
static const double size[2] = {210, 297};

enum { N_REFUSED = sizeof refused / sizeof *refused };

START_TEST(what_is_not_known_is_refused)
{
  thr_text svg = {0};
  thr_err err = {0};
  thr_paper *paper;
  thr_text_printf(&svg, "%s%s</svg>", HEAD, refused[_i][0]);
  ck_assert_int_eq(thr_paper_open(&paper, size, no_fonts, &err), THR_OK);
  assert_status(thr_svg_page(paper, &svg, &err), THR_ESOLVER, &err, refused[_i][1]);
  thr_paper_destroy(paper);
  thr_text_destroy(&svg);
}
END_TEST

/* A document cut off anywhere is refused or, where only the end of its last line lacks, drawn. */
START_TEST(half_a_document_is_refused)
{
  thr_text whole = {0};
  thr_paper *paper;
  thr_text_printf(&whole, "%s%s</svg>", HEAD, pictures[_i]);
  ck_assert_int_eq(thr_paper_open(&paper, size, no_fonts, NULL), THR_OK);
  for (size_t n = 0; n < whole.length; n++) {
    thr_text svg = {0};
    thr_err err = {0};
    thr_text_append_bytes(&svg, whole.data, n);
    ck_assert_int_eq(thr_svg_page(paper, &svg, &err), THR_ESOLVER);
    thr_text_destroy(&svg);
  }
  thr_paper_destroy(paper);
  thr_text_destroy(&whole);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("svg_page");
  ADD_EXAMPLES(s, 30, pictures_are_those_of_librsvg, N_PICTURES);
  ADD_EXAMPLES(s, 60, sheets_are_those_of_librsvg, 3);
  ADD_TEST(s, 30, words_are_found_as_they_are_written);
  ADD_EXAMPLES(s, 30, what_is_not_known_is_refused, N_REFUSED);
  ADD_EXAMPLES(s, 30, half_a_document_is_refused, N_PICTURES);
  return run_suite(s);
}
