#define _POSIX_C_SOURCE 200809L
#include "diagram/export/paper.h"
#include "graph/process/lazy.h"

#include <cairo-pdf.h>
#include <librsvg/rsvg.h>
#include <stdlib.h>

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

/* Is every object of a PDF where its table of objects (xref) says? Where cairo has no memory for the stream of a font, it goes on
 * without, says nothing, and the font is an object that is not there. */
static bool holds_all(const thr_text *pdf)
{
  static const char keyword[] = "startxref";
  enum { ENTRY = 20 }; /* bytes: ten digits of the place, five, n or f, the end of the line */
  char head[32];
  size_t last = sizeof keyword - 1, at = pdf->length, place = 0;
  if (pdf->length <= last) return false;
  for (at -= last; at > 0 && memcmp(pdf->data + at, keyword, last) != 0; at--) {
  }
  int n = 0, used = 0;
  if (at > 0 && sscanf(pdf->data + at + last, "%zu", &place) != 1) return false;
  if (at == 0 || place >= at || sscanf(pdf->data + place, "xref 0 %d %n", &n, &used) != 1 || n < 1) return false;
  place += (size_t)used;
  if (at < place || (at - place) / ENTRY < (size_t)n) return false;
  for (int i = 1; i < n; i++) {
    size_t object = strtoul(pdf->data + place + (size_t)i * ENTRY, NULL, 10);
    int length = snprintf(head, sizeof head, "%d 0 obj", i);
    if (pdf->data[place + (size_t)i * ENTRY + 17] != 'n') continue;
    if (object + (size_t)length > at || memcmp(pdf->data + object, head, (size_t)length) != 0) return false;
  }
  return true;
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
  return holds_all(out) ? THR_OK : thr_nomem(err);
}
