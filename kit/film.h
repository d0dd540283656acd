/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A movement of a kit's pieces as pictures: opaque pieces on a level ground with their shadow,
 * cords between their mouths in the colours of their tension, and below that a line of what the
 * frame says in numbers. The camera stands still and sees all frames. As numbered PNG files, and as
 * one PNG that moves (APNG), which browsers and viewers of pictures play.
 *
 *   thr_movement movement;                          diagram/scene/movement.h
 *   thr_film_movement(&movement, kit, 100, err);    everything assembled and at rest
 *   movement.pose[frame * n_pieces + piece] = ..    what moves
 *   thr_film_open(&film, kit, &movement, &(thr_film_options){0}, err);
 *   thr_film_write(film, "rise", &animation, limits, err);
 *
 * film.c draws, film_marks.c has the colours and the words, picture.c the pieces, picture_png.c the
 * files. A kit without names (thr_kit_options) takes a part of the time; one whose meshes are 2.5
 * times as coarse has slivers that are seen as specks. */
#ifndef THR_FILM_H
#define THR_FILM_H

#include "diagram/scene/movement.h"
#include "kit/picture.h"

/* How a film is made. {0} is the usual film. */
typedef struct {
  int size[2];               /* px; 0 = 640 x 480 */
  bool from;                 /* look from this direction, else as in kit.png */
  double azimuth, elevation; /* rad */
  bool translucent;          /* cords are seen through the pieces, too */
  double most;               /* N, where the colours of tension end; 0 = at the largest one */
  int marked;                /* number of a piece in a colour of its own, from 1; 0 = none */
} thr_film_options;

/* Makes the movement of a kit's pieces and of the cords of its plan, for so many frames, in all of
 * which everything is assembled; no tension is known, nothing is said of faces, and the floor is
 * below the lowest piece. An open cord's points are its first end, both mouths of each pass as the
 * needle goes, its other end; a closed cord's are the mouths, and the first one again. So pass k is
 * between points 2 k + 1 and 2 k + 2 of an open cord, 2 k and 2 k + 1 of a closed one: the gap
 * between two solids, or the inside of a tube. The kit has meshes. THR_ENOMEM. Release with
 * thr_movement_destroy, after a failure too. O(frames (pieces + passes)). */
thr_status thr_film_movement(thr_movement *movement, const thr_kit *kit, int n_frames,
                             thr_err *err) THR_MUST_CHECK;

typedef struct thr_film thr_film;

/* Opens a film. Kit, which has meshes, and movement, which has frames, are borrowed and must
 * outlive the film. THR_EINPUT: the movement is of other pieces, some place in it is not finite, a
 * frame is shown for no time or longer than a minute, a size is below 64 or above 4000 px, or there
 * is no such piece. THR_ENOMEM. Release with thr_film_close (NULL ok). O(frames pieces +
 * triangles). */
thr_status thr_film_open(thr_film **film, const thr_kit *kit, const thr_movement *movement,
                         const thr_film_options *options, thr_err *err) THR_MUST_CHECK;
void thr_film_close(thr_film *film);

/* Refuses a movement that cannot be shown: THR_EINPUT, as for thr_film_open. O(frames pieces). */
thr_status thr_film_check(const thr_kit *kit, const thr_movement *movement,
                          thr_err *err) THR_MUST_CHECK;

/* Return from where a film sees the world (px per mm), and its colours. */
thr_camera_view thr_film_view(const thr_film *film);
const thr_png_palette *thr_film_palette(const thr_film *film);

/* Draws a frame, from 0: index[width * height] receives the numbers of its colours, 1 to 255, row
 * by row from the top. The same frame gives the same bytes, whatever was drawn before. THR_ENOMEM.
 * O(triangles + px). */
thr_status thr_film_frame(thr_film *film, int frame, unsigned char *index,
                          thr_err *err) THR_MUST_CHECK;

/* Writes all frames, drawing each once: as frame-0001.png and so on into a folder that exists,
 * NULL: not; and appended to a text as an animation whose last picture stays for two seconds, NULL:
 * not. Frames must number less than 10000 for a folder (THR_EINPUT). THR_EIO: a file; THR_ELIMIT
 * when stopped; THR_ENOMEM: the animation is not whole then. */
thr_status thr_film_write(thr_film *film, const char *folder, thr_text *animation,
                          const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* ---- film_marks.c: colours and words ---- */

/* Steps of the colours of tension, the last one for what is not known. */
enum { THR_FILM_TENSIONS = 16 };

/* A picture that is drawn on: red, green and blue row by row from the top. */
typedef struct {
  unsigned char *pixel;
  int size[2];
} thr_film_canvas;

/* Fills the colours of tensions, red, green and blue, 0 to 1: ever lighter from blue over red to
 * yellow, so that lightness alone tells their order, then grey. */
void thr_film_tensions(double colour[THR_FILM_TENSIONS][3]);

/* Returns the number of the colour of a tension where the colours end at `most`, both N. */
int thr_film_tension(double tension, double most);

/* Returns the tension that the colours of a movement end at, N: the largest one, rounded up to two
 * digits; 0 if none is known. O(frames points). */
double thr_film_most(const thr_movement *movement);

/* Fills the palette: number 0 is black and unused. */
void thr_film_colours(thr_png_palette *palette);

/* Returns the height of the strip for words at the bottom of a picture, px. */
int thr_film_strip(const int size[2]);

/* Writes into that strip what a frame says, on the left, and on the right what the colours mean if
 * `most`, N, is above 0. */
void thr_film_caption(thr_film_canvas *canvas, const thr_movement *movement, int frame,
                      double most);

#endif
