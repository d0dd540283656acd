#include "diagram/export/viewer.h"

#include "diagram/scene/copies.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/scene.h"
#include "diagram/overview/svg.h"
#include "diagram/overview/tension.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TICKS = 4, RAMP = 24 };

typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  const char *const *motion;
  thr_guide guide;
  thr_copy *copy; /* [n_cords] */
  bool tension;   /* are there any? */
  double range[2];
  int most; /* passes of one bead */
  thr_text *out;
} viewer;

/* ---- pieces ---- */

static void put_string(viewer *s, const char *before, const char *string)
{
  thr_text_append(s->out, before);
  thr_text_json_string(s->out, string);
}

/* Takes the words. */
static void put_words(viewer *s, const char *before, thr_text *words)
{
  put_string(s, before, words->data ? words->data : "");
  if (words->failed) s->out->failed = true;
  thr_text_destroy(words);
}

static const char *comma(int i)
{
  return i ? "," : "";
}

/* ---- the framework ---- */

static void put_nodes(viewer *s)
{
  const thr_frame *f = s->f;
  thr_text_append(s->out, ",\n\"nodes\":[");
  for (int v = 0; v < f->n_nodes; v++)
    thr_text_printf(s->out, "%s[%.7g,%.7g,%.7g]", comma(v), f->xyz[v][0], f->xyz[v][1], f->xyz[v][2]);
  thr_text_append(s->out, "],\n\"outward\":[");
  for (int v = 0; v < f->n_nodes; v++) {
    const double *n = s->guide.outward[v];
    thr_text_printf(s->out, "%s[%.3g,%.3g,%.3g]", comma(v), n[0], n[1], n[2]);
  }
  thr_text_append(s->out, "],\n\"labels\":[");
  for (int v = 0; v < f->n_nodes; v++)
    put_string(s, comma(v), s->guide.label[v]);
  thr_text_append(s->out, "],\n\"places\":[");
  for (int v = 0; v < f->n_nodes; v++) {
    thr_text place = {0};
    thr_guide_place(&s->guide, v, &place);
    put_words(s, comma(v), &place);
  }
  thr_text_append(s->out, "],\n\"feet\":[");
  for (int v = 0, n = 0; v < f->n_nodes; v++)
    if (f->foot && f->foot[v]) thr_text_printf(s->out, "%s%d", comma(n++), v);
  thr_text_append(s->out, "]");
}

static void put_edges(viewer *s)
{
  const thr_frame *f = s->f;
  thr_text_append(s->out, ",\n\"edges\":[");
  for (int e = 0; e < f->n_edges; e++)
    thr_text_printf(s->out, "%s[%d,%d]", comma(e), f->edge[e][0], f->edge[e][1]);
  thr_text_append(s->out, "],\n\"lengths\":[");
  for (int e = 0; e < f->n_edges; e++)
    thr_text_printf(s->out, "%s%.7g", comma(e), f->length[e]);
  thr_text_append(s->out, "]");
}

/* ---- the cords ---- */

static void put_tension(viewer *s, const thr_eval_cord *r)
{
  thr_text force = {0};
  char text[32], hex[8];
  thr_svg_force(r->force, text);
  thr_text_printf(&force, "pull at %s: %s", r->pull == THR_PULL_BOTH ? "both ends" : thr_pull_name(r->pull), text);
  put_words(s, ",\n \"pull\":", &force);
  thr_text_append(s->out, ",\"tension\":[");
  for (int k = 0; k < r->n_passes; k++)
    thr_text_printf(s->out, "%s%.4g", comma(k), r->tension[k]);
  thr_text_append(s->out, "],\"taut\":[");
  for (int k = 0; k < r->n_passes; k++) {
    thr_tension_colour(s->range, r->tension[k], hex);
    put_string(s, comma(k), hex);
  }
  thr_text_append(s->out, "]");
}

static void put_cord(viewer *s, int c)
{
  const thr_cord *cord = &s->plan->cord[c];
  thr_colour colour = thr_palette(s->copy[c].path);
  char words[192] = "";
  if (s->copy[c].of != c) thr_copies_words(s->plan, s->copy, c, s->motion, words);
  put_string(s, c ? ",\n{\"id\":" : "\n{\"id\":", cord->id);
  thr_text_printf(s->out, ",\"closed\":%s,\"of\":%d,\"path\":%d", cord->closed ? "true" : "false", s->copy[c].of,
                  s->copy[c].path);
  put_string(s, ",\"how\":", words);
  put_string(s, ",\"colour\":", colour.hex);
  put_string(s, ",\"pale\":", colour.pale);
  thr_svg_length(thr_cord_length(s->f, cord), s->f->units, words);
  put_string(s, ",\"length\":", words);
  thr_text_append(s->out, ",\n \"half\":[");
  for (int k = 0; k < cord->n_passes; k++)
    thr_text_printf(s->out, "%s%d", comma(k), cord->half[k]);
  thr_text_append(s->out, "],\n \"turns\":[");
  for (int k = 0; k < cord->n_passes; k++) {
    thr_text turn = {0};
    if (k > 0)
      thr_guide_say(&s->guide, cord->half[k - 1], cord->half[k], &turn);
    else
      thr_text_append(&turn, "go");
    put_words(s, comma(k), &turn);
  }
  thr_text_append(s->out, "]");
  if (s->tension && s->plan->evaluation.cord[c].known) put_tension(s, &s->plan->evaluation.cord[c]);
  thr_text_append(s->out, "}");
}

/* ---- the whole ---- */

static void put_scale(viewer *s)
{
  double tick[TICKS];
  char text[32], hex[8];
  int n = thr_svg_ticks(s->range[0], s->range[1], s->range[0] > 0, TICKS, tick);
  put_string(s, ",\n\"scale\":{\"method\":", thr_tension_method_words(&s->plan->evaluation));
  thr_text_printf(s->out, ",\"low\":%.7g,\"high\":%.7g,\"ticks\":[", s->range[0], s->range[1]);
  for (int i = 0; i < n; i++) {
    thr_svg_force(tick[i], text);
    thr_text_printf(s->out, "%s[%.7g,", comma(i), tick[i]);
    put_string(s, "", text);
    thr_text_append(s->out, "]");
  }
  thr_text_append(s->out, "],\"ramp\":[");
  for (int i = 0; i <= RAMP; i++) { /* the colours are even over the logarithm */
    double part = (double)i / RAMP;
    thr_tension_colour(s->range, s->range[0] * pow(s->range[1] / s->range[0], part), hex);
    put_string(s, comma(i), hex);
  }
  thr_text_append(s->out, "]}");
}

static void put_plan(viewer *s)
{
  const thr_plan *p = s->plan;
  thr_text_printf(s->out, "{\"format\":\"thread-viewer\",\"version\":1,\"frame\":\"%016" PRIx64 "\"", thr_frame_hash(s->f));
  put_string(s, ",\"units\":", s->f->units);
  put_string(s, ",\"seen\":", thr_layout_words(s->guide.layout.kind));
  thr_text_printf(s->out, ",\"sides\":%s,\"paths\":%d", s->guide.sides ? "true" : "false", thr_copies_paths(s->copy, p->n_cords));
  thr_text_append(s->out, ",\n\"nth\":[");
  for (int i = 1; i <= s->most; i++) {
    char nth[16];
    thr_guide_ordinal(i, nth);
    put_string(s, comma(i - 1), nth);
  }
  /* one cord on its own changes its colour on the way, as in the overview */
  thr_text_printf(s->out, "],\n\"run\":%d,\"palette\":[", p->n_cords == 1 ? THR_COLOUR_PASSES : 0);
  for (int i = 0; i < THR_COLOURS; i++)
    put_string(s, comma(i), thr_palette(i).hex);
  thr_text_append(s->out, "]");
  put_nodes(s);
  put_edges(s);
  if (s->tension) put_scale(s);
  thr_text_append(s->out, ",\n\"cords\":[");
  for (int c = 0; c < p->n_cords; c++)
    put_cord(s, c);
  thr_text_append(s->out, "]}");
}

/* Appends JSON as it may stand in a <script>: no "<", which only strings hold; line separators are escaped in them already. */
static void put_in_script(const thr_text *json, thr_text *out)
{
  const char *from = json->data, *end = from + json->length;
  for (const char *at = from; at < end; at++) {
    if (*at != '<') continue;
    thr_text_append_bytes(out, from, (size_t)(at - from));
    thr_text_append(out, "\\u003c");
    from = at + 1;
  }
  thr_text_append_bytes(out, from, (size_t)(end - from));
}

static thr_status prepare(viewer *s, thr_err *err)
{
  const thr_plan *p = s->plan;
  int n_passes;
  thr_status st = thr_scene_check_cords(p, &n_passes, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  s->tension = !st && p->evaluation.present && thr_evaluation_range(&p->evaluation, s->range);
  if (s->tension) st = thr_tension_usable(p, err);
  if (st) return st;
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  int *held = thr_calloc((size_t)s->f->n_edges, sizeof *held);
  st = s->copy && held ? thr_guide_make(&s->guide, s->f, err) : thr_nomem(err);
  if (!st) st = thr_copies_find(p, s->copy, err);
  for (int c = 0; c < p->n_cords && !st; c++)
    for (int k = 0; k < p->cord[c].n_passes; k++) {
      int now = ++held[p->cord[c].half[k] >> 1];
      if (now > s->most) s->most = now;
    }
  free(held);
  return st;
}

thr_status thr_viewer_html(const thr_plan *p, const char *const *motion, thr_text *html, thr_err *err)
{
  thr_text json = {0}, page = {0};
  viewer s = {.plan = p, .f = &p->frame, .motion = motion, .out = &json};
  const char *mark = strstr(thr_viewer_page, THR_VIEWER_MARK);
  assert(mark);
  thr_status st = prepare(&s, err);
  if (st) goto done;
  put_plan(&s);
  thr_text_append_bytes(&page, thr_viewer_page, (size_t)(mark - thr_viewer_page));
  if (!json.failed) put_in_script(&json, &page);
  thr_text_append(&page, mark + strlen(THR_VIEWER_MARK));
  if (!json.failed && !page.failed) thr_text_append_bytes(html, page.data, page.length);
  if (json.failed || page.failed || html->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&json);
  thr_text_destroy(&page);
  thr_guide_destroy(&s.guide);
  free(s.copy);
  return st;
}
