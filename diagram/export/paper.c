#define _POSIX_C_SOURCE 200809L
#include "diagram/export/paper.h"
#include "graph/angle.h"
#include "graph/process/lazy.h"

#include <cairo-pdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__
/* fontconfig keeps what it has read of fonts until the process ends, where the leak checker cannot see it. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

const char *__lsan_default_suppressions(void)
{
  return "leak:libfontconfig";
}

const char *__lsan_default_options(void)
{
  return "print_suppressions=0";
}
#endif

#define FUNCTIONS(F)                                                                                                             \
  F(cairo_arc)                                                                                                                   \
  F(cairo_clip)                                                                                                                  \
  F(cairo_close_path)                                                                                                            \
  F(cairo_create)                                                                                                                \
  F(cairo_curve_to)                                                                                                              \
  F(cairo_destroy)                                                                                                               \
  F(cairo_fill)                                                                                                                  \
  F(cairo_fill_preserve)                                                                                                         \
  F(cairo_line_to)                                                                                                               \
  F(cairo_move_to)                                                                                                               \
  F(cairo_new_path)                                                                                                              \
  F(cairo_new_sub_path)                                                                                                          \
  F(cairo_pdf_surface_create_for_stream)                                                                                         \
  F(cairo_pdf_surface_set_metadata)                                                                                              \
  F(cairo_rectangle)                                                                                                             \
  F(cairo_restore)                                                                                                               \
  F(cairo_save)                                                                                                                  \
  F(cairo_scale)                                                                                                                 \
  F(cairo_select_font_face)                                                                                                      \
  F(cairo_set_dash)                                                                                                              \
  F(cairo_set_font_size)                                                                                                         \
  F(cairo_set_line_cap)                                                                                                          \
  F(cairo_set_line_join)                                                                                                         \
  F(cairo_set_line_width)                                                                                                        \
  F(cairo_set_miter_limit)                                                                                                       \
  F(cairo_set_source_rgba)                                                                                                       \
  F(cairo_show_page)                                                                                                             \
  F(cairo_show_text)                                                                                                             \
  F(cairo_status)                                                                                                                \
  F(cairo_status_to_string)                                                                                                      \
  F(cairo_stroke)                                                                                                                \
  F(cairo_surface_destroy)                                                                                                       \
  F(cairo_surface_finish)                                                                                                        \
  F(cairo_surface_status)                                                                                                        \
  F(cairo_text_extents)                                                                                                          \
  F(cairo_translate)

/* Of cairo. */
static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

static thr_status load(thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  return thr_lazy_load(&lib.loaded, THR_LIBRARY_CAIRO, symbol, sizeof symbol / sizeof *symbol, err);
}

static const double POINT = 25.4 / 72; /* mm */

struct thr_paper {
  cairo_surface_t *surface;
  cairo_t *cairo;
  const thr_text *out; /* borrowed */
};

static cairo_status_t append(void *out, const unsigned char *bytes, unsigned int n)
{
  thr_text *text = out;
  thr_text_append_bytes(text, (const char *)bytes, n);
  return text->failed ? CAIRO_STATUS_WRITE_ERROR : CAIRO_STATUS_SUCCESS;
}

static thr_status failed(cairo_status_t status, thr_err *err)
{
  if (status == CAIRO_STATUS_NO_MEMORY || status == CAIRO_STATUS_WRITE_ERROR) return thr_nomem(err);
  return thr_fail(err, THR_ESOLVER, "cairo cannot write the PDF: %s", lib.cairo_status_to_string(status));
}

/* cairo puts the time of day into a file that has no date. */
static void describe(cairo_surface_t *surface, const char *title)
{
  static const char epoch[] = "2000-01-01T00:00:00Z";
  lib.cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
  lib.cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, epoch);
  lib.cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_MOD_DATE, epoch);
}

/* In mm; mitres as long as in SVG. */
static void begin_page(thr_paper *paper)
{
  lib.cairo_save(paper->cairo);
  lib.cairo_scale(paper->cairo, 1 / POINT, 1 / POINT);
  lib.cairo_set_miter_limit(paper->cairo, 4);
}

thr_status thr_paper_open(thr_paper **paper, thr_page_size size, const char *title, thr_text *out, thr_err *err)
{
  double mm[2];
  *paper = NULL;
  thr_status st = load(err);
  if (st) return st;
  thr_page_mm(size, mm);
  thr_paper *new = *paper = thr_calloc(1, sizeof *new);
  if (!new) return thr_nomem(err);
  new->out = out;
  new->surface = lib.cairo_pdf_surface_create_for_stream(append, out, mm[0] / POINT, mm[1] / POINT);
  new->cairo = lib.cairo_create(new->surface);
  cairo_status_t status = lib.cairo_status(new->cairo);
  if (status) return failed(status, err);
  describe(new->surface, title);
  begin_page(new);
  return THR_OK;
}

thr_status thr_paper_turn(thr_paper *paper, thr_err *err)
{
  lib.cairo_restore(paper->cairo);
  lib.cairo_show_page(paper->cairo);
  begin_page(paper);
  cairo_status_t status = lib.cairo_status(paper->cairo);
  return status ? failed(status, err) : THR_OK;
}

/* ---- drawing ---- */

void thr_paper_push(thr_paper *paper)
{
  lib.cairo_save(paper->cairo);
}

void thr_paper_pop(thr_paper *paper)
{
  lib.cairo_restore(paper->cairo);
}

void thr_paper_shift(thr_paper *paper, const double by[2])
{
  lib.cairo_translate(paper->cairo, by[0], by[1]);
}

void thr_paper_move(thr_paper *paper, const double to[2])
{
  lib.cairo_move_to(paper->cairo, to[0], to[1]);
}

void thr_paper_line(thr_paper *paper, const double to[2])
{
  lib.cairo_line_to(paper->cairo, to[0], to[1]);
}

void thr_paper_curve(thr_paper *paper, const double a[2], const double b[2], const double to[2])
{
  lib.cairo_curve_to(paper->cairo, a[0], a[1], b[0], b[1], to[0], to[1]);
}

void thr_paper_end(thr_paper *paper)
{
  lib.cairo_close_path(paper->cairo);
}

void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2], double radius)
{
  if (radius <= 0) {
    lib.cairo_rectangle(paper->cairo, at[0], at[1], size[0], size[1]);
    return;
  }
  lib.cairo_new_sub_path(paper->cairo);
  for (int i = 0; i < 4; i++) {
    double x = at[0] + (i == 0 || i == 3 ? size[0] - radius : radius), y = at[1] + (i < 2 ? size[1] - radius : radius);
    lib.cairo_arc(paper->cairo, x, y, radius, i * THR_PI / 2, (i + 1) * THR_PI / 2);
  }
  lib.cairo_close_path(paper->cairo);
}

void thr_paper_circle(thr_paper *paper, const double middle[2], double radius)
{
  lib.cairo_new_sub_path(paper->cairo);
  lib.cairo_arc(paper->cairo, middle[0], middle[1], radius, 0, 2 * THR_PI);
  lib.cairo_close_path(paper->cairo);
}

static void take_ink(cairo_t *cairo, const thr_ink *ink)
{
  lib.cairo_set_source_rgba(cairo, ink->colour[0], ink->colour[1], ink->colour[2], ink->opacity);
}

void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line)
{
  cairo_t *cairo = paper->cairo;
  if (fill) {
    take_ink(cairo, fill);
    if (line)
      lib.cairo_fill_preserve(cairo);
    else
      lib.cairo_fill(cairo);
  }
  if (line) {
    take_ink(cairo, &line->ink);
    lib.cairo_set_line_width(cairo, line->width);
    lib.cairo_set_line_cap(cairo, line->round_ends ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    lib.cairo_set_line_join(cairo, line->round_corners ? CAIRO_LINE_JOIN_ROUND : CAIRO_LINE_JOIN_MITER);
    lib.cairo_set_dash(cairo, line->dash, line->n_dash, line->dash_offset);
    lib.cairo_stroke(cairo);
  }
  lib.cairo_new_path(cairo);
}

void thr_paper_clip(thr_paper *paper)
{
  lib.cairo_clip(paper->cairo);
}

void thr_paper_text(thr_paper *paper, const double at[2], const thr_letters *letters, const char *words)
{
  cairo_t *cairo = paper->cairo;
  cairo_text_extents_t extents = {0};
  lib.cairo_select_font_face(cairo, letters->mono ? "DejaVu Sans Mono" : "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                             letters->bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  lib.cairo_set_font_size(cairo, letters->size);
  if (letters->anchor > 0) lib.cairo_text_extents(cairo, words, &extents);
  take_ink(cairo, &letters->ink);
  lib.cairo_move_to(cairo, at[0] - letters->anchor * extents.x_advance, at[1]);
  lib.cairo_show_text(cairo, words);
  lib.cairo_new_path(cairo);
}

/* ---- the end ---- */

/* Where text stands last; NULL if it does not. */
static const char *last_of(const thr_text *pdf, const char *text)
{
  size_t length = strlen(text);
  for (size_t at = pdf->length; at >= length; at--)
    if (memcmp(pdf->data + at - length, text, length) == 0) return pdf->data + at - length;
  return NULL;
}

/* Is every object of a PDF where its table of objects (xref) says? Where cairo has no memory for the stream of a font, it goes on
 * without, says nothing, and the font is an object that is not there. Newer versions of cairo have no such table: true. */
static bool holds_all(const thr_text *pdf)
{
  enum { ENTRY = 20, KIND = 17 }; /* bytes: ten digits of the place, five, n or f, the end of the line */
  const char *start = last_of(pdf, "startxref");
  size_t place = 0, end = start ? (size_t)(start - pdf->data) : 0;
  int n = 0, used = 0;
  if (!start || sscanf(start, "startxref %zu", &place) != 1 || place >= pdf->length) return false;
  if (strncmp(pdf->data + place, "xref", 4) != 0) return true;
  if (sscanf(pdf->data + place, "xref 0 %d %n", &n, &used) != 1 || n < 1) return false;
  place += (size_t)used;
  if (end < place || (end - place) / ENTRY < (size_t)n) return false;
  for (int i = 1; i < n; i++) {
    char head[32];
    const char *entry = pdf->data + place + (size_t)i * ENTRY;
    size_t object = strtoul(entry, NULL, 10);
    int length = snprintf(head, sizeof head, "%d 0 obj", i);
    if (entry[KIND] == 'n' && (object >= end || strncmp(pdf->data + object, head, (size_t)length) != 0)) return false;
  }
  return true;
}

/* Where fontconfig finds no font, or has no memory to look for one, pages are drawn without their words. */
static bool has_fonts(const thr_text *pdf)
{
  return last_of(pdf, "/FontFile") || last_of(pdf, "/ObjStm"); /* in there it would be compressed */
}

thr_status thr_paper_close(thr_paper *paper, thr_err *err)
{
  if (!paper) return THR_OK;
  const thr_text *out = paper->out;
  lib.cairo_destroy(paper->cairo);
  lib.cairo_surface_finish(paper->surface);
  cairo_status_t status = lib.cairo_surface_status(paper->surface);
  lib.cairo_surface_destroy(paper->surface);
  free(paper);
  if (status) return failed(status, err);
  if (!holds_all(out)) return thr_nomem(err);
  return has_fonts(out)
             ? THR_OK
             : thr_fail(err, THR_ESOLVER, "no font was found for the words of the PDF; install one, as fonts-dejavu-core");
}
