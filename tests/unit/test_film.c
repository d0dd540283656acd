/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Movements of pieces as pictures: pieces are seen where their poses put them, cords in the colours
 * of their tension, and the files have the same pixels as the frames. */
#define _POSIX_C_SOURCE 200809L
#include "kit/film.h"

#include "diagram/scene/movement.h"
#include "diagram/space/space.h"
#include "graph/io/json.h"
#include "graph/number.h"
#include "kit/files.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 6, WIDE = 160, HIGH = 120 };

/* What a test draws: a path of three nodes along x, 40 mm apart. */
typedef struct {
  thr_plan plan;
  thr_kit kit;
  thr_movement movement;
} theatre;

/* Makes the kit, coarse and without names, and a movement of it. */
static void open_theatre(theatre *of, thr_joint joint)
{
  static const thr_limits limits = {.threads = 1};
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES, .coarse = 3};
  thr_err err = {0};
  thr_frame frame = path_make(3);
  for (int v = 0; v < frame.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      frame.xyz[v][k] *= 40;
  for (int e = 0; e < frame.n_edges; e++)
    frame.length[e] *= 40;
  frame.foot[0] = false;
  of->plan = plan_simple(&frame, THR_ENDS_ANY, 1);
  of->plan.options.joint = joint;
  thr_frame_destroy(&frame);
  ck_assert_msg(thr_kit_make(&of->kit, &of->plan, &options, NULL, true, &limits, &err) == THR_OK,
                "%s", err.text);
  ck_assert_int_eq(thr_film_movement(&of->movement, &of->kit, FRAMES, &err), THR_OK);
}

static void close_theatre(theatre *of)
{
  thr_movement_destroy(&of->movement);
  thr_kit_destroy(&of->kit);
  thr_plan_destroy(&of->plan);
}

/* Returns the pose of a piece in a frame. */
static double *pose_of(theatre *of, int frame, int piece)
{
  return of->movement.pose[frame * of->movement.n_pieces + piece];
}

/* Lets every piece fly along a parabola of its own onto its assembled place, turning about z. */
static void throw_pieces(theatre *of)
{
  for (int frame = 0; frame < FRAMES; frame++) {
    double left = 1 - (double)frame / (FRAMES - 1);
    of->movement.state[frame] =
        (thr_movement_state){.time = frame * 0.1, .pull = 10 * frame, .drawn = frame};
    for (int p = 0; p < of->movement.n_pieces; p++) {
      double *pose = pose_of(of, frame, p);
      pose[0] += 20 * (p - 1) * left;
      pose[1] += 30 * left;
      pose[2] += 60 * left * left;
      pose[5] = sin(0.6 * left);
      pose[6] = cos(0.6 * left);
    }
  }
}

static thr_film *open_film(theatre *of, const thr_film_options *options)
{
  thr_film *film;
  thr_err err = {0};
  ck_assert_msg(thr_film_open(&film, &of->kit, &of->movement, options, &err) == THR_OK, "%s",
                err.text);
  return film;
}

/* Returns the colour of a pixel of a frame. */
static const unsigned char *colour_at(const thr_film *film, const unsigned char *index, int x,
                                      int y)
{
  return thr_film_palette(film)->colour[index[y * WIDE + x]];
}

START_TEST(turns_are_rotations)
{
  /* A quarter about z takes x to y; lengths of quaternions do not matter. */
  double turn[9];
  thr_movement_turn((const double[]){0, 0, 0, 0, 0, 3, 3}, turn);
  const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  for (int i = 0; i < 9; i++)
    ck_assert_double_eq_tol(turn[i], quarter[i], 1e-12);

  /* Any one has unit rows at right angles, and is not mirrored. */
  thr_movement_turn((const double[]){0, 0, 0, 0.3, -0.2, 0.7, -0.4}, turn);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      ck_assert_double_eq_tol(thr_dot(turn + 3 * i, turn + 3 * j), i == j, 1e-12);
  double cross[3];
  thr_cross(turn, turn + 3, cross);
  ck_assert_double_eq_tol(thr_dot(cross, turn + 6), 1, 1e-12);
}
END_TEST

START_TEST(cords_run_from_mouth_to_mouth)
{
  for (int tube = 0; tube < 2; tube++) {
    theatre of;
    open_theatre(&of, tube ? THR_JOINT_TUBE : THR_JOINT_SOLID);
    const thr_movement *movement = &of.movement;
    ck_assert_int_eq(movement->n_cords, 1);
    ck_assert_int_eq(movement->first[1], 6);

    /* Assembled, the two mouths of a joint are a gap apart, those of a tube its length. */
    double at[6][3];
    for (int i = 0; i < 6; i++)
      thr_movement_place(movement, 0, i, at[i]);
    for (int k = 0; k < 2; k++) {
      int piece = movement->point[1 + 2 * k].piece, other = movement->point[2 + 2 * k].piece;
      ck_assert_int_eq(abs(piece - other), !tube);
      double between = thr_distance(at[1 + 2 * k], at[2 + 2 * k]);
      if (tube)
        ck_assert_double_gt(between, 30);
      else
        ck_assert_double_lt(between, 1);
    }
    /* The ends stick out of the outer pieces, and the world stays where it is. */
    ck_assert_double_gt(fabs(at[0][0] - 40), fabs(at[1][0] - 40));
    of.movement.point[5] = (thr_movement_point){-1, {7, 8, 9}};
    thr_movement_place(movement, 3, 5, at[5]);
    ck_assert_double_eq(at[5][1], 8);
    close_theatre(&of);
  }
}
END_TEST

START_TEST(pieces_are_seen_where_they_are)
{
  theatre of;
  open_theatre(&of, THR_JOINT_TUBE);
  throw_pieces(&of);
  const thr_film_options options = {.size = {WIDE, HIGH}, .marked = 2};
  thr_film *film = open_film(&of, &options);
  thr_camera_view view = thr_film_view(film);
  unsigned char index[WIDE * HIGH];
  thr_err err = {0};

  for (int frame = 0; frame < FRAMES; frame++) {
    /* The middle of the green pixels is the tube's middle. */
    ck_assert_int_eq(thr_film_frame(film, frame, index, &err), THR_OK);
    double sum[2] = {0, 0}, n = 0, at[3];
    for (int i = 0; i < WIDE * HIGH; i++) {
      const unsigned char *colour = colour_at(film, index, i % WIDE, i / WIDE);
      if (colour[1] < colour[0] + 40) continue;
      sum[0] += i % WIDE + 0.5;
      sum[1] += i / WIDE + 0.5;
      n++;
    }
    ck_assert_double_gt(n, 50);
    thr_camera_project(&view, pose_of(&of, frame, 1), at);
    for (int k = 0; k < 2; k++)
      ck_assert_double_eq_tol(sum[k] / n, at[k], 2.5);
  }
  thr_film_close(film);
  close_theatre(&of);
}
END_TEST

START_TEST(a_frame_is_the_picture_of_its_poses)
{
  /* A movement in which the order of frames is turned round, drawn after others, has the same
   * pictures; a turn by a whole circle changes nothing. */
  theatre of, back;
  open_theatre(&of, THR_JOINT_SOLID);
  open_theatre(&back, THR_JOINT_SOLID);
  throw_pieces(&of);
  for (int frame = 0; frame < FRAMES; frame++) {
    back.movement.state[frame] = of.movement.state[FRAMES - 1 - frame];
    for (int p = 0; p < 3; p++)
      for (int k = 0; k < 7; k++)
        pose_of(&back, frame, p)[k] = (k < 3 ? 1 : -1) * pose_of(&of, FRAMES - 1 - frame, p)[k];
  }
  const thr_film_options options = {.size = {WIDE, HIGH}};
  thr_film *film = open_film(&of, &options), *other = open_film(&back, &options);
  static unsigned char index[2][WIDE * HIGH], before[WIDE * HIGH];
  thr_err err = {0};
  for (int frame = 0; frame < FRAMES; frame++) {
    ck_assert_int_eq(thr_film_frame(film, frame, index[0], &err), THR_OK);
    ck_assert_int_eq(thr_film_frame(other, FRAMES - 1 - frame, index[1], &err), THR_OK);
    ck_assert_mem_eq(index[0], index[1], sizeof index[0]);
    ck_assert(memcmp(index[0], before, sizeof before) != 0);
    memcpy(before, index[0], sizeof before);
  }
  thr_film_close(film);
  thr_film_close(other);
  close_theatre(&of);
  close_theatre(&back);
}
END_TEST

START_TEST(cords_have_the_colours_of_their_tension)
{
  /* Seen from the side, the middle of the gap between the first two pieces, drawn apart. */
  theatre of;
  open_theatre(&of, THR_JOINT_SOLID);
  int n = of.movement.first[1];
  for (int frame = 0; frame < FRAMES; frame++) {
    for (int p = 0; p < 3; p++)
      pose_of(&of, frame, p)[0] *= 2;
    for (int i = 0; i < n; i++)
      of.movement.tension[frame * n + i] = frame == 2 ? NAN : 20.0 * frame;
  }
  const thr_film_options options = {.size = {WIDE, HIGH}, .from = true, .azimuth = -THR_PI / 2};
  thr_film *film = open_film(&of, &options);
  thr_camera_view view = thr_film_view(film);
  unsigned char index[WIDE * HIGH];
  thr_err err = {0};
  double at[2][3], eye[3], light = 0;
  for (int i = 0; i < 2; i++)
    thr_movement_place(&of.movement, 0, 1 + i, at[i]);
  for (int k = 0; k < 3; k++)
    eye[k] = 0.5 * (at[0][k] + at[1][k]);
  thr_camera_project(&view, eye, at[0]);

  for (int frame = 0; frame < FRAMES; frame++) {
    ck_assert_int_eq(thr_film_frame(film, frame, index, &err), THR_OK);
    const unsigned char *colour = colour_at(film, index, (int)at[0][0], (int)at[0][1]);
    double sum = 0.2 * colour[0] + 0.7 * colour[1] + 0.1 * colour[2];
    int spread = 0; /* grey has little */
    for (int k = 0; k < 3; k++)
      if (abs(colour[k] - colour[(k + 1) % 3]) > spread)
        spread = abs(colour[k] - colour[(k + 1) % 3]);
    if (frame == 2) {
      ck_assert_int_lt(spread, 40);
      continue;
    }
    ck_assert_int_gt(spread, 60);
    ck_assert_double_gt(sum, light);
    light = sum;
  }
  thr_film_close(film);
  close_theatre(&of);
}
END_TEST

/* Reads a number of four bytes, the largest first. */
static uint32_t number_at(const char *bytes)
{
  uint32_t number = 0;
  for (size_t i = 0; i < 4; i++)
    number = number << 8 | (unsigned char)bytes[i];
  return number;
}

START_TEST(files_are_written)
{
  /* tests/film.py, which decodes them by other means, gives a folder of its own. */
  const char *given = getenv("THREAD_FILM_FOLDER");
  char folder[] = "/tmp/thread-film-XXXXXX", path[256];
  if (!given) ck_assert_ptr_nonnull(mkdtemp(folder));
  const char *into = given ? given : folder;
  theatre of;
  open_theatre(&of, THR_JOINT_SOLID);
  throw_pieces(&of);
  /* Two frames that are alike. */
  of.movement.state[2] = of.movement.state[1];
  memcpy(pose_of(&of, 2, 0), pose_of(&of, 1, 0), 3 * sizeof *of.movement.pose);
  const thr_film_options options = {.size = {WIDE, HIGH}};
  thr_film *film = open_film(&of, &options);
  thr_err err = {0};
  thr_text animation = {0}, again = {0};
  ck_assert_msg(thr_film_write(film, into, &animation, NULL, &err) == THR_OK, "%s", err.text);
  ck_assert_int_eq(thr_film_write(film, NULL, &again, NULL, &err), THR_OK);
  ck_assert_uint_eq(animation.length, again.length);
  ck_assert_mem_eq(animation.data, again.data, again.length);

  /* Chunks: as many pictures as frames, numbered without a gap, the third one of a single pixel. */
  uint32_t numbered = 0, pictures = 0;
  for (size_t at = 8; at < animation.length; at += 12 + number_at(animation.data + at)) {
    const char *chunk = animation.data + at + 4;
    bool control = memcmp(chunk, "fcTL", 4) == 0, pixels = memcmp(chunk, "fdAT", 4) == 0;
    if (memcmp(chunk, "acTL", 4) == 0) ck_assert_uint_eq(number_at(chunk + 4), FRAMES);
    if (control || pixels) ck_assert_uint_eq(number_at(chunk + 4), numbered++);
    if (control && ++pictures == 3) ck_assert_uint_eq(number_at(chunk + 8), 1);
  }
  ck_assert_uint_eq(pictures, FRAMES);

  snprintf(path, sizeof path, "%s/film.png", into);
  ck_assert_int_eq(thr_text_write(&animation, path, &err), THR_OK);
  if (!given) {
    ck_assert_int_eq(unlink(path), 0);
    for (int frame = 1; frame <= FRAMES; frame++) {
      snprintf(path, sizeof path, "%s/frame-%04d.png", into, frame);
      ck_assert_int_eq(unlink(path), 0);
    }
    ck_assert_int_eq(rmdir(folder), 0);
  }
  thr_text_destroy(&animation);
  thr_text_destroy(&again);
  thr_film_close(film);
  close_theatre(&of);
}
END_TEST

START_TEST(what_cannot_be_filmed_is_refused)
{
  theatre of;
  open_theatre(&of, THR_JOINT_SOLID);
  const struct {
    thr_film_options options;
    const char *word;
  } bad[] = {{{.size = {63, 90}}, "px"}, {{.size = {90, 4001}}, "px"}, {{.marked = 4}, "pieces"}};
  thr_film *film;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_err err = {0};
    ck_assert_int_eq(thr_film_open(&film, &of.kit, &of.movement, &bad[i].options, &err),
                     THR_EINPUT);
    assert_one_line(&err, bad[i].word);
    ck_assert_ptr_null(film);
  }
  for (int i = 0; i < 4; i++) {
    thr_err err = {0};
    thr_movement changed = of.movement;
    changed.n_pieces += i == 0;
    changed.seconds = i == 1 ? 0 : 1;
    changed.floor = i == 2 ? NAN : 0;
    pose_of(&of, 1, 1)[2] = i == 3 ? INFINITY : 0;
    ck_assert_int_eq(thr_film_open(&film, &of.kit, &changed, &(thr_film_options){0}, &err),
                     THR_EINPUT);
    const char *word[] = {"pieces", "60 s", "nowhere", "frame 2"};
    assert_one_line(&err, word[i]);
  }

  /* A folder that is not there; and a piece that sank into the ground is drawn. */
  pose_of(&of, 1, 1)[2] = -500;
  thr_err err = {0};
  film = open_film(&of, &(thr_film_options){.size = {WIDE, HIGH}});
  ck_assert_int_eq(thr_film_write(film, "/tmp/no-such-folder/thread", NULL, NULL, &err), THR_EIO);
  assert_one_line(&err, "frame-0001.png");
  unsigned char index[WIDE * HIGH];
  ck_assert_int_eq(thr_film_frame(film, 1, index, &err), THR_OK);
  thr_film_close(film);
  close_theatre(&of);
}
END_TEST

/* What the viewer's page plays; tests/viewer/test.cjs reads the places on the page. */
START_TEST(the_page_gets_all_frames)
{
  theatre of;
  open_theatre(&of, THR_JOINT_SOLID);
  throw_pieces(&of);
  of.movement.n_faces = 2;
  of.movement.tension[0] = 3.14;
  thr_status st = THR_ENOMEM;
  for (long fail = 1; st == THR_ENOMEM; fail++) {
    ck_assert_int_lt(fail, 2000);
    thr_err err = {0};
    thr_text moves = {0}, pieces = {0};
    thr_alloc_fail_at(fail);
    st = thr_kit_moves(&of.kit, &of.movement, "title", "note", &moves, &err);
    if (!st) thr_kit_viewer(&of.kit, &moves, &pieces);
    if (pieces.failed) st = THR_ENOMEM;
    thr_alloc_fail_at(0);
    if (!st) {
      thr_json *doc;
      ck_assert_int_eq(thr_json_parse(&doc, pieces.data, pieces.length, "page", &err), THR_OK);
      const thr_json *in = thr_json_get(doc, "moves"), *words = thr_json_get(in, "words");
      ck_assert_int_eq(thr_json_size(words), FRAMES);
      ck_assert_str_eq(thr_json_string(thr_json_at(words, 1)),
                       "0.10 s, pull 10.00 N, 0 of 2 faces closed, 1 mm drawn in");
      ck_assert_int_eq(thr_json_size(thr_json_get(in, "colours")), THR_FILM_TENSIONS);
      double high;
      ck_assert(thr_json_number(thr_json_get(thr_json_get(in, "scale"), "high"), &high));
      ck_assert_double_eq(high, 3.2);
      const thr_json *ticks = thr_json_get(thr_json_get(in, "scale"), "ticks");
      ck_assert_int_eq(thr_json_size(ticks), 2);
      for (int i = 0; i < 2; i++)
        ck_assert_str_eq(thr_json_string(thr_json_at(thr_json_at(ticks, i), 1)),
                         i ? "3.20 N" : "0 N");
      const size_t bytes = FRAMES * (size_t)of.kit.n_pieces * 7 * 2;
      ck_assert_uint_eq(strlen(thr_json_string(thr_json_get(in, "poses"))), (bytes + 2) / 3 * 4);
      thr_json_destroy(doc);
    }
    thr_text_destroy(&moves);
    thr_text_destroy(&pieces);
  }
  ck_assert_int_eq(st, THR_OK);

  thr_err err = {0};
  thr_text moves = {0};
  pose_of(&of, 1, 1)[2] = INFINITY;
  ck_assert_int_eq(thr_kit_moves(&of.kit, &of.movement, "", "", &moves, &err), THR_EINPUT);
  assert_one_line(&err, "frame 2");
  thr_text_destroy(&moves);
  close_theatre(&of);
}
END_TEST

START_TEST(memory_runs_out_cleanly)
{
  theatre of;
  open_theatre(&of, THR_JOINT_SOLID);
  const thr_film_options options = {.size = {64, 64}};
  thr_status st = THR_ENOMEM;
  for (long fail = 1; st == THR_ENOMEM; fail++) {
    ck_assert_int_lt(fail, 2000);
    thr_err err = {0};
    thr_film *film = NULL;
    thr_movement movement;
    thr_text animation = {0};
    thr_alloc_fail_at(fail);
    st = thr_film_movement(&movement, &of.kit, 2, &err);
    if (!st) st = thr_film_open(&film, &of.kit, &movement, &options, &err);
    if (!st) st = thr_film_write(film, NULL, &animation, NULL, &err);
    thr_alloc_fail_at(0);
    thr_film_close(film);
    thr_movement_destroy(&movement);
    thr_text_destroy(&animation);
  }
  ck_assert_int_eq(st, THR_OK);
  close_theatre(&of);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("film");
  ADD_TEST(s, 20, turns_are_rotations);
  ADD_TEST(s, 20, cords_run_from_mouth_to_mouth);
  ADD_TEST(s, 20, pieces_are_seen_where_they_are);
  ADD_TEST(s, 20, a_frame_is_the_picture_of_its_poses);
  ADD_TEST(s, 20, cords_have_the_colours_of_their_tension);
  ADD_TEST(s, 20, files_are_written);
  ADD_TEST(s, 20, what_cannot_be_filmed_is_refused);
  ADD_TEST(s, 60, the_page_gets_all_frames);
  ADD_TEST(s, 60, memory_runs_out_cleanly);
  return run_suite(s);
}
