/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the frames of a movement: finds a camera that sees all of them, moves the pieces by their
 * poses and the cords with the pieces, and takes for every pixel the nearest colour of one palette.
 *
 * A piece's mesh goes to its assembled place and from there on by the frame's pose; x is
 * pose + R (P x), with R of the pose's quaternion and P of the kit. Where everything is in all
 * frames is bounded by a ball around each piece, so that the camera costs no more than the poses.
 *
 * Example: dome7 rising in 100 frames is a file of some 3 MB. */
#include "kit/film.h"

#include "graph/number.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST = 64, MOST = 4000, NEAR = 64, MOST_FILES = 9999 };

static const double AZIMUTH = -1.05, ELEVATION = 0.4; /* as for kit.png */
static const double RIM = 0.03;                       /* of the picture, on every side */
static const double THIN = 1.8;                       /* px: cords are drawn no thinner */
static const double TAIL = 2; /* of a node's radius: how far cords stick out of it */
static const double LAST = 2; /* s for which an animation's last picture is shown */

struct thr_film {
  const thr_kit *kit;
  const thr_movement *movement;
  thr_film_options options;
  thr_camera_view view;
  double most; /* N, end of the colours */
  double tension[THR_FILM_TENSIONS][3];
  thr_png_palette palette;
  unsigned char *nearest; /* [NEAR^3] number of the colour nearest to a colour, 0: not yet known */
  thr_kit_stage *stage;
  double (*place)[12];
  double (*line)[2][3];
  int *colour;
  unsigned char *pixel;
  thr_scratch own;
};

/* ---- cords of a kit ---- */

/* Adds a point to the cords of a movement, at a place from a piece's centre. */
static void add_point(thr_movement *movement, int *n, int piece, const double at[3])
{
  movement->point[*n].piece = piece;
  memcpy(movement->point[(*n)++].at, at, sizeof movement->point->at);
}

/* Finds the arm of a piece, or the end of a tube, that a half-edge leaves by or leads to. */
static const thr_kit_arm *find_arm(const thr_kit_piece *piece, int half)
{
  for (int i = 0; i < piece->n_arms; i++)
    if (piece->arm[i].half == half) return &piece->arm[i];
  assert(false);
  return NULL;
}

/* Adds both mouths of a pass, as the needle goes. off: where it is in its bore. */
static void add_pass(thr_movement *movement, int *n, const thr_kit *kit, int half, int pass,
                     const double off[3])
{
  const thr_kit_edge *edge = &kit->edges.edge[half >> 1];
  const double *lane = edge->lane[edge->n_lanes > 1 ? kit->edges.lane[pass] : 0];
  for (int i = 0; i < 2; i++) {
    int side = half ^ i; /* looks to its own tail */
    int tail = thr_head(&kit->plan->frame, side ^ 1);
    int p = kit->piece[0].tube ? half >> 1 : tail;
    const thr_kit_piece *piece = &kit->piece[p];
    const thr_kit_arm *arm = piece->tube ? &piece->arm[(half & 1) ^ !i] : find_arm(piece, side);
    double at[3];
    for (int k = 0; k < 3; k++)
      at[k] =
          arm->length * arm->along[k] + lane[0] * edge->up[k] + lane[1] * edge->side[k] + off[k];
    add_point(movement, n, p, at);
  }
}

/* Adds an end of an open cord, which sticks out of its piece: that of its first pass, or its last
 * one. */
static void add_end(thr_movement *movement, int *n, const thr_kit *kit, int c, bool first)
{
  const thr_cord *cord = &kit->plan->cord[c];
  int half = cord->half[first ? 0 : cord->n_passes - 1];
  if (kit->piece[0].tube) {
    const thr_kit_piece *piece = &kit->piece[half >> 1];
    const thr_kit_arm *arm = &piece->arm[(half & 1) ^ first];
    double at[3];
    for (int k = 0; k < 3; k++)
      at[k] = (arm->length + TAIL * arm->width) * arm->along[k];
    add_point(movement, n, half >> 1, at);
    return;
  }

  const thr_kit_piece *piece = &kit->piece[thr_head(&kit->plan->frame, first ? half ^ 1 : half)];
  double at[3] = {0, 0, 0};
  for (int i = 0; i < piece->n_channels; i++) {
    const thr_kit_channel *channel = &piece->channel[i];
    if (channel->cord != c || (first ? channel->in : channel->out) >= 0) continue;
    memcpy(at, channel->point[first ? 0 : channel->n - 1], sizeof at);
    double length = sqrt(thr_dot(at, at));
    for (int k = 0; k < 3 && length > TAIL * piece->node_radius; k++)
      at[k] *= TAIL * piece->node_radius / length;
    if (piece->foot) at[2] = fmax(at[2], -piece->base);
    break;
  }
  add_point(movement, n, piece->piece, at);
}

/* Fills the points of all cords. */
static void add_cords(thr_movement *movement, const thr_kit *kit, const double (*off)[3])
{
  int n = 0;
  for (int c = 0; c < kit->plan->n_cords; c++) {
    const thr_cord *cord = &kit->plan->cord[c];
    int begin = n;
    if (!cord->closed) add_end(movement, &n, kit, c, true);
    for (int k = 0; k < cord->n_passes; k++) {
      int pass = kit->edges.first_pass[c] + k;
      add_pass(movement, &n, kit, cord->half[k], pass, off[pass]);
    }
    if (cord->closed)
      movement->point[n++] = movement->point[begin];
    else
      add_end(movement, &n, kit, c, false);
  }
  assert(n == movement->first[movement->n_cords]);
}

/* Returns the height of the lowest point of the assembled kit. */
static double find_floor(const thr_kit *kit)
{
  double low = HUGE_VAL, at[3];
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh *mesh = &kit->mesh[kit->piece[p].like];
    for (int i = 0; i < mesh->n_points; i++) {
      thr_kit_place(&kit->piece[p], mesh->point[i], at);
      low = fmin(low, at[2]);
    }
  }
  return low;
}

thr_status thr_film_movement(thr_movement *movement, const thr_kit *kit, int n_frames, thr_err *err)
{
  *movement = (thr_movement){0};
  int n_cords = kit->plan->n_cords;
  thr_scratch own = {0};
  int *n_points = thr_scratch_array(&own, (size_t)n_cords + 1, sizeof *n_points);
  double(*off)[3] =
      thr_scratch_array(&own, (size_t)kit->edges.first_pass[n_cords] + 1, sizeof *off);
  thr_status st = thr_scratch_check(&own, err);
  for (int c = 0; c < n_cords && !st; c++)
    n_points[c] = 2 * kit->plan->cord[c].n_passes + (kit->plan->cord[c].closed ? 1 : 2);
  if (!st) st = thr_kit_edges_share(&kit->edges, kit->plan, kit->cord, off, err);
  if (!st) st = thr_movement_make(movement, kit->n_pieces, n_frames, n_cords, n_points, err);
  if (!st) {
    add_cords(movement, kit, (const double(*)[3])off);
    movement->floor = find_floor(kit);
    for (int i = 0; i < n_frames * kit->n_pieces; i++)
      memcpy(movement->pose[i], kit->piece[i % kit->n_pieces].centre, sizeof kit->piece->centre);
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- the camera ---- */

thr_status thr_film_check(const thr_kit *kit, const thr_movement *movement, thr_err *err)
{
  if (movement->n_pieces != kit->n_pieces)
    return thr_fail(err, THR_EINPUT, "a movement of %d pieces, but the kit has %d",
                    movement->n_pieces, kit->n_pieces);
  if (!(movement->seconds > 0 && movement->seconds <= 60))
    return thr_fail(err, THR_EINPUT, "a frame is shown for up to 60 s, not %g", movement->seconds);
  bool fine = isfinite(movement->floor);
  for (int i = 0; i < movement->first[movement->n_cords] && fine; i++)
    for (int k = 0; k < 3; k++)
      fine = fine && isfinite(movement->point[i].at[k]) && movement->point[i].piece < kit->n_pieces;
  if (!fine) return thr_fail(err, THR_EINPUT, "the floor or a point of a cord is nowhere");

  for (int i = 0; i < movement->n_frames * movement->n_pieces; i++) {
    const double *pose = movement->pose[i];
    double square = pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6];
    fine = isfinite(square) && square > 0;
    for (int k = 0; k < 3; k++)
      fine = fine && fabs(pose[k]) < 1e6;
    if (!fine)
      return thr_fail(err, THR_EINPUT, "piece %s flew away by frame %d",
                      kit->name[i % movement->n_pieces], i / movement->n_pieces + 1);
  }
  return THR_OK;
}

/* A box that grows: in the world, and as the camera sees it, mm. */
typedef struct {
  double low[5], high[5]; /* x, y, z; right, up */
} bounds;

/* Adds a ball to a box. */
static void add_ball(bounds *box, const thr_camera *camera, const double at[3], double radius)
{
  const double on[5] = {at[0], at[1], at[2], thr_dot(at, camera->right), thr_dot(at, camera->up)};
  for (int k = 0; k < 5; k++) {
    box->low[k] = fmin(box->low[k], on[k] - radius);
    box->high[k] = fmax(box->high[k], on[k] + radius);
  }
}

/* Finds the box of all frames. */
static bounds find_bounds(const thr_film *film)
{
  const thr_kit *kit = film->kit;
  const thr_movement *movement = film->movement;
  const thr_camera *camera = &film->view.camera;
  bounds box;
  for (int k = 0; k < 5; k++) {
    box.low[k] = HUGE_VAL;
    box.high[k] = -HUGE_VAL;
  }
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh *mesh = &kit->mesh[kit->piece[p].like];
    double square = 0;
    for (int i = 0; i < mesh->n_points; i++)
      square = fmax(square, thr_dot(mesh->point[i], mesh->point[i]));
    for (int frame = 0; frame < movement->n_frames; frame++)
      add_ball(&box, camera, movement->pose[frame * movement->n_pieces + p], sqrt(square));
  }
  for (int i = 0; i < movement->first[movement->n_cords]; i++)
    for (int frame = 0; frame < movement->n_frames; frame++) {
      double at[3];
      thr_movement_place(movement, frame, i, at);
      add_ball(&box, camera, at, 0.5 * kit->cord);
    }
  return box;
}

/* Chooses scale and middle such that a box is seen above the strip for words, and opens the stage.
 */
static thr_status set_stage(thr_film *film, thr_err *err)
{
  const int *size = film->options.size;
  const double strip = thr_film_strip(size);
  thr_camera_view *view = &film->view;
  bounds box = find_bounds(film);
  double wide = fmax(box.high[3] - box.low[3], 1e-6), high = fmax(box.high[4] - box.low[4], 1e-6);

  view->size[0] = size[0];
  view->size[1] = size[1];
  view->scale = (1 - 2 * RIM) * fmin(size[0] / wide, (size[1] - strip) / high);
  view->middle[0] = 0.5 * (box.low[3] + box.high[3]);
  view->middle[1] = -0.5 * (box.low[4] + box.high[4]) + 0.5 * strip / view->scale;

  thr_kit_stage_options stage = {.view = *view,
                                 .floor = film->movement->floor,
                                 .cord = fmax(film->kit->cord, THIN / view->scale),
                                 .colour = (const double(*)[3])film->tension,
                                 .opaque = !film->options.translucent,
                                 .marked = film->options.marked,
                                 .height = fmax(box.high[2] - film->movement->floor, 0)};
  double across = fmax(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  stage.wide = 1.4 * across; /* a rim of a fifth is left for the blur */
  for (int k = 0; k < 2; k++)
    stage.corner[k] = 0.5 * (box.low[k] + box.high[k]) - 0.7 * across;
  return thr_kit_stage_open(&film->stage, film->kit, &stage, err);
}

/* ---- opening ---- */

void thr_film_close(thr_film *film)
{
  if (!film) return;
  thr_kit_stage_close(film->stage);
  thr_scratch_free(&film->own);
  free(film);
}

thr_status thr_film_open(thr_film **film, const thr_kit *kit, const thr_movement *movement,
                         const thr_film_options *options, thr_err *err)
{
  *film = NULL;
  thr_status st = thr_film_check(kit, movement, err);
  if (st) return st;
  thr_film *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->kit = kit;
  made->movement = movement;
  made->options = *options;
  int *size = made->options.size;
  for (int k = 0; k < 2 && !st; k++) {
    size[k] = size[k] ? size[k] : k ? 480 : 640;
    if (size[k] < LEAST || size[k] > MOST)
      st = thr_fail(err, THR_EINPUT, "a film is %d to %d px wide and high, not %d", LEAST, MOST,
                    size[k]);
  }
  if (!st && (options->marked < 0 || options->marked > kit->n_pieces))
    st = thr_fail(err, THR_EINPUT, "the kit has %d pieces, not a piece %d", kit->n_pieces,
                  options->marked);

  size_t px = st ? 0 : (size_t)size[0] * (size_t)size[1];
  size_t points = (size_t)movement->first[movement->n_cords] + 1;
  made->place = thr_scratch_array(&made->own, (size_t)kit->n_pieces, sizeof *made->place);
  made->line = thr_scratch_array(&made->own, points, sizeof *made->line);
  made->colour = thr_scratch_array(&made->own, points, sizeof *made->colour);
  made->nearest = thr_scratch_array(&made->own, NEAR * NEAR * NEAR, 1);
  made->pixel = thr_scratch_array(&made->own, px + 1, 3);
  if (!st) st = thr_scratch_check(&made->own, err);
  if (!st) {
    made->view.camera = options->from ? thr_camera_at(options->azimuth, options->elevation)
                                      : thr_camera_at(AZIMUTH, ELEVATION);
    made->most = options->most > 0 ? options->most : thr_film_most(movement);
    thr_film_tensions(made->tension);
    thr_film_colours(&made->palette);
    st = set_stage(made, err);
  }
  if (st) {
    thr_film_close(made);
    return st;
  }
  *film = made;
  return THR_OK;
}

thr_camera_view thr_film_view(const thr_film *film)
{
  return film->view;
}

const thr_png_palette *thr_film_palette(const thr_film *film)
{
  return &film->palette;
}

/* ---- frames ---- */

/* Returns the number of the palette's colour that is nearest to a pixel. Colours are told apart by
 * six bits. */
static unsigned char find_nearest(thr_film *film, const unsigned char pixel[3])
{
  enum { DROP = 2 };
  int part[3], best = 1;
  long least = 0;
  for (int k = 0; k < 3; k++)
    part[k] = pixel[k] >> DROP;
  unsigned char *known = &film->nearest[(part[0] * NEAR + part[1]) * NEAR + part[2]];
  if (*known) return *known;

  /* The middle of what shares the six bits; white stays white. */
  for (int i = 1; i < 256; i++) {
    long far = 0;
    for (int k = 0; k < 3; k++) {
      int value = part[k] == NEAR - 1 ? 255 : (part[k] << DROP) + 1;
      far += (long)(value - film->palette.colour[i][k]) * (value - film->palette.colour[i][k]);
    }
    if (i > 1 && far >= least) continue;
    least = far;
    best = i;
  }
  return *known = (unsigned char)best;
}

/* Lays the cords of a frame; without those parts that opaque pieces hide. Returns how many straight
 * parts there are. */
static int lay_cords(thr_film *film, int frame)
{
  const thr_movement *movement = film->movement;
  int n = 0, n_points = movement->first[movement->n_cords];
  for (int c = 0; c < movement->n_cords; c++)
    for (int i = movement->first[c]; i + 1 < movement->first[c + 1]; i++) {
      int piece = movement->point[i].piece;
      bool end = i == movement->first[c] || i + 2 == movement->first[c + 1];
      bool inside = piece >= 0 && piece == movement->point[i + 1].piece && !end;
      if (inside && !film->options.translucent) continue;
      for (int k = 0; k < 2; k++)
        thr_movement_place(movement, frame, i + k, film->line[n][k]);
      film->colour[n++] = thr_film_tension(
          movement->tension[(size_t)frame * (size_t)n_points + (size_t)i], film->most);
    }
  return n;
}

thr_status thr_film_frame(thr_film *film, int frame, unsigned char *index, thr_err *err)
{
  const thr_movement *movement = film->movement;
  assert(frame >= 0 && frame < movement->n_frames);

  /* From meshes to the assembled framework, and on by the poses. */
  for (int p = 0; p < movement->n_pieces; p++) {
    const double *pose = movement->pose[(size_t)frame * (size_t)movement->n_pieces + (size_t)p];
    const double *assembled = film->kit->piece[p].place;
    double turn[9];
    thr_movement_turn(pose, turn);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        film->place[p][3 * i + j] = turn[3 * i] * assembled[j] +
                                    turn[3 * i + 1] * assembled[3 + j] +
                                    turn[3 * i + 2] * assembled[6 + j];
      film->place[p][9 + i] = pose[i];
    }
  }

  const thr_kit_scene scene = {.place = (const double(*)[12])film->place,
                               .n_lines = lay_cords(film, frame),
                               .line = (const double(*)[2][3])film->line,
                               .colour = film->colour};
  thr_status st = thr_kit_stage_draw(film->stage, &scene, film->pixel, err);
  if (st) return st;
  thr_film_canvas canvas = {film->pixel, {film->options.size[0], film->options.size[1]}};
  thr_film_caption(&canvas, movement, frame, film->most);

  size_t px = (size_t)canvas.size[0] * (size_t)canvas.size[1];
  for (size_t i = 0; i < px; i++)
    index[i] = find_nearest(film, film->pixel + 3 * i);
  return THR_OK;
}

/* ---- files ---- */

/* Writes a frame as a file of its own. */
static thr_status write_frame(const thr_film *film, const char *folder, int frame,
                              const unsigned char *index, thr_err *err)
{
  thr_text path = {0}, png = {0};
  thr_text_printf(&path, "%s/frame-%04d.png", folder, frame + 1);
  thr_status st = thr_png_write_indexed(index, film->options.size, &film->palette, &png, err);
  if (!st && path.failed) st = thr_nomem(err);
  if (!st) st = thr_text_write(&png, path.data, err);
  thr_text_destroy(&path);
  thr_text_destroy(&png);
  return st;
}

thr_status thr_film_write(thr_film *film, const char *folder, thr_text *animation,
                          const thr_limits *limits, thr_err *err)
{
  const thr_movement *movement = film->movement;
  const int *size = film->options.size;
  thr_apng apng = {0};
  if (folder && movement->n_frames > MOST_FILES)
    return thr_fail(err, THR_EINPUT, "%d frames, but files are numbered up to %d",
                    movement->n_frames, MOST_FILES);
  unsigned char *index = thr_calloc((size_t)size[0] * (size_t)size[1], 1);
  thr_status st = index ? THR_OK : thr_nomem(err);
  if (!st && animation)
    st = thr_apng_begin(&apng, size, movement->n_frames, &film->palette, animation, err);
  for (int frame = 0; frame < movement->n_frames && !st; frame++) {
    if (limits && limits->advance)
      limits->advance(limits->user, "drawing frames", (double)frame / movement->n_frames);
    if (limits && thr_limits_stop(limits)) st = thr_fail(err, THR_ELIMIT, "stopped");
    if (!st) st = thr_film_frame(film, frame, index, err);
    if (!st && folder) st = write_frame(film, folder, frame, index, err);
    if (!st && animation)
      st = thr_apng_add(&apng, index, frame + 1 < movement->n_frames ? movement->seconds : LAST,
                        err);
  }
  if (!st && animation) st = thr_apng_end(&apng, err);
  thr_apng_destroy(&apng);
  free(index);
  return st;
}
