#include "diagram/paper.h"

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

static const double POINT = 25.4 / 72; /* mm */

struct thr_paper {
  cairo_surface_t *surface;
  cairo_t *cairo;
  double width, height; /* pt */
};

const char *thr_page_name(thr_page_size s)
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
  thr_text *t = out;
  thr_text_append_bytes(t, (const char *)bytes, n);
  return t->failed ? CAIRO_STATUS_WRITE_ERROR : CAIRO_STATUS_SUCCESS;
}

static thr_status failed(cairo_status_t status, thr_err *err)
{
  if (status == CAIRO_STATUS_NO_MEMORY || status == CAIRO_STATUS_WRITE_ERROR) return thr_nomem(err);
  return thr_fail(err, THR_ESOLVER, "cairo cannot write the PDF: %s", cairo_status_to_string(status));
}

/* cairo puts the time of day into a file that has no date. */
static void describe(cairo_surface_t *surface, const char *title)
{
  static const char epoch[] = "2000-01-01T00:00:00Z";
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, epoch);
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_MOD_DATE, epoch);
}

thr_status thr_paper_open(thr_paper **p, thr_page_size size, const char *title, thr_text *out, thr_err *err)
{
  double mm[2];
  thr_page_mm(size, mm);
  thr_paper *new = *p = thr_calloc(1, sizeof *new);
  if (!new) return thr_nomem(err);
  new->width = mm[0] / POINT;
  new->height = mm[1] / POINT;
  new->surface = cairo_pdf_surface_create_for_stream(append, out, new->width, new->height);
  new->cairo = cairo_create(new->surface);
  cairo_status_t status = cairo_status(new->cairo);
  if (status) return failed(status, err);
  describe(new->surface, title);
  return THR_OK;
}

thr_status thr_paper_add(thr_paper *p, const thr_text *svg, thr_err *err)
{
  GError *why = NULL;
  thr_status st = THR_OK;
  if (svg->failed) return thr_nomem(err);
  RsvgHandle *page = rsvg_handle_new_from_data((const guint8 *)(svg->data ? svg->data : ""), svg->length, &why);
  RsvgRectangle whole = {0, 0, p->width, p->height};
  if (!page || !rsvg_handle_render_document(page, p->cairo, &whole, &why))
    st = thr_fail(err, THR_ESOLVER, "librsvg cannot draw a page: %s", why ? why->message : "no reason given");
  if (page) g_object_unref(page);
  g_clear_error(&why);
  cairo_show_page(p->cairo);
  cairo_status_t status = cairo_status(p->cairo);
  return !st && status ? failed(status, err) : st;
}

thr_status thr_paper_close(thr_paper *p, thr_err *err)
{
  if (!p) return THR_OK;
  cairo_destroy(p->cairo);
  cairo_surface_finish(p->surface);
  cairo_status_t status = cairo_surface_status(p->surface);
  cairo_surface_destroy(p->surface);
  free(p);
  return status ? failed(status, err) : THR_OK;
}
