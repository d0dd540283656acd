#define _POSIX_C_SOURCE 200809L
#include "diagram/export/paper.h"
#include "graph/process/lazy.h"

#include <cairo-pdf.h>
#include <librsvg/rsvg.h>
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
  F(cairo_create)                                                                                                                \
  F(cairo_destroy)                                                                                                               \
  F(cairo_pdf_surface_create_for_stream)                                                                                         \
  F(cairo_pdf_surface_set_metadata)                                                                                              \
  F(cairo_show_page)                                                                                                             \
  F(cairo_status)                                                                                                                \
  F(cairo_status_to_string)                                                                                                      \
  F(cairo_surface_destroy)                                                                                                       \
  F(cairo_surface_finish)                                                                                                        \
  F(cairo_surface_status)                                                                                                        \
  F(g_error_free)                                                                                                                \
  F(g_object_unref)                                                                                                              \
  F(rsvg_handle_new_from_data)                                                                                                   \
  F(rsvg_handle_render_document)

/* Of librsvg, and of what it needs itself: cairo and GLib. */
static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

/* GLib must not allocate by slices: where memory is out it says so with the lock of slices held, and waits for itself. */
static thr_status load(thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  if (setenv("G_SLICE", "always-malloc", 0)) return thr_nomem(err);
  return thr_lazy_load(&lib.loaded, THR_LIBRARY_RSVG_2, symbol, sizeof symbol / sizeof *symbol, err);
}

static const double POINT = 25.4 / 72; /* mm */

struct thr_paper {
  cairo_surface_t *surface;
  cairo_t *cairo;
  double width, height; /* pt */
  const thr_text *out;  /* borrowed */
};

const char *thr_page_name(int s)
{
  static const char *const name[] = {"a4", "letter"};
  return name[s];
}

void thr_page_mm(thr_page_size s, double size[2])
{
  static const double mm[][2] = {{210, 297}, {215.9, 279.4}};
  for (int i = 0; i < 2; i++)
    size[i] = mm[s][i];
}

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
  new->width = mm[0] / POINT;
  new->height = mm[1] / POINT;
  new->surface = lib.cairo_pdf_surface_create_for_stream(append, out, new->width, new->height);
  new->cairo = lib.cairo_create(new->surface);
  cairo_status_t status = lib.cairo_status(new->cairo);
  if (status) return failed(status, err);
  describe(new->surface, title);
  return THR_OK;
}

thr_status thr_paper_add(thr_paper *paper, const thr_text *svg, thr_err *err)
{
  GError *why = NULL;
  thr_status st = THR_OK;
  if (svg->failed) return thr_nomem(err);
  RsvgHandle *page = lib.rsvg_handle_new_from_data((const guint8 *)(svg->data ? svg->data : ""), svg->length, &why);
  RsvgRectangle whole = {0, 0, paper->width, paper->height};
  if (!page || !lib.rsvg_handle_render_document(page, paper->cairo, &whole, &why))
    st = thr_fail(err, THR_ESOLVER, "librsvg cannot draw a page: %s", why ? why->message : "no reason given");
  if (page) lib.g_object_unref(page);
  if (why) lib.g_error_free(why);
  lib.cairo_show_page(paper->cairo);
  cairo_status_t status = lib.cairo_status(paper->cairo);
  return !st && status ? failed(status, err) : st;
}

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
