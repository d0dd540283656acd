/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture of a kit: the pieces where they belong, translucent, with the cords in their channels.
 *
 * picture.c chooses the view and draws; picture_raster.c fills triangles into samples and says what
 * colour these have; picture_png.c writes the file. All use parallel projection (see
 * diagram/space/camera.c). */
#ifndef THR_KIT_PICTURE_H
#define THR_KIT_PICTURE_H

#include "diagram/space/space.h"
#include "kit/kit.h"

/* ---- picture.c ---- */

/* What is drawn, and from where. {0} is the usual picture. */
typedef struct {
  int size[2];               /* px; 0 = 1200 x 900 */
  bool from;                 /* look from this direction, else from the front and above */
  double azimuth, elevation; /* rad */
  int alone;                 /* number of the only piece that is drawn, from 1; 0 = all. Unless
                                `from`, one looks into its largest mouth */
  bool opaque;               /* cords are seen only where they are outside */
  double explode; /* by which all pieces are further from their middle; 0 = 1, in their places */
  const thr_limits *limits; /* whose advance hears which part is drawn; NULL: nobody; borrowed */
} thr_kit_view;

/* Makes the picture: *pixel[3 * size[0] * size[1]] receives red, green and blue row by row from the
 * top, to be freed, and size what it is. Failures as below. */
thr_status thr_kit_pixels(const thr_kit *kit, const thr_kit_view *view, unsigned char **pixel,
                          int size[2], thr_err *err) THR_MUST_CHECK;

/* Appends the picture as PNG of 8 bits red, green and blue. The kit has meshes. The same kit and
 * view give the same bytes. THR_EINPUT: no such piece, or a size below 16 or above 10000 px;
 * THR_ENOMEM. png is unchanged on failure. O(triangles + px). */
thr_status thr_kit_picture(const thr_kit *kit, const thr_kit_view *view, thr_text *png,
                           thr_err *err) THR_MUST_CHECK;

/* ---- picture.c: pictures of one kit whose pieces are anywhere, from one direction, for film.c */

/* How all pictures of a stage are taken. Lengths in mm. */
typedef struct {
  thr_camera_view view;      /* mm become px */
  double floor;              /* height of the level ground */
  double corner[2], wide;    /* a square of the ground that all shadows fall into */
  double height;             /* of what is high above the ground and hardly darkens it */
  double cord;               /* diameter that cords are drawn with */
  const double (*colour)[3]; /* of cords: red, green, blue, 0 to 1; borrowed */
  bool opaque;               /* cords are seen only where they are outside */
  int marked;                /* number of a piece in a colour of its own, from 1; 0 = none */
} thr_kit_stage_options;

/* Where everything is in one picture. */
typedef struct {
  const double (*place)[12];  /* [n_pieces] from a piece's mesh into the world: rotation by rows,
                                 then where the mesh's origin goes, mm */
  int n_lines;                /* straight parts of cords .. */
  const double (*line)[2][3]; /* [n_lines] .. between two points, mm */
  const int *colour;          /* [n_lines] number of its colour */
} thr_kit_scene;

/* What pictures of a kit share. */
typedef struct thr_kit_stage thr_kit_stage;

/* Opens a stage. The kit has meshes, and must outlive the stage. THR_ENOMEM. Release with
 * thr_kit_stage_close (NULL ok). O(triangles). */
thr_status thr_kit_stage_open(thr_kit_stage **stage, const thr_kit *kit,
                              const thr_kit_stage_options *options, thr_err *err) THR_MUST_CHECK;
void thr_kit_stage_close(thr_kit_stage *stage);

/* Draws a scene: pixel[3 * width * height] receives red, green and blue row by row from the top.
 * The same scene gives the same bytes. THR_ENOMEM. O(triangles + px). */
thr_status thr_kit_stage_draw(thr_kit_stage *stage, const thr_kit_scene *scene,
                              unsigned char *pixel, thr_err *err) THR_MUST_CHECK;

/* ---- picture_raster.c ---- */

/* Samples in each direction of a pixel, and parts of a sample by which corners are placed. */
enum { THR_SAMPLES = 3, THR_SAMPLE_PARTS = 16 };

/* Where rays through the picture meet something. Depths in mm, larger = nearer to the eye. */
typedef struct {
  float cord, surface;    /* depth of the nearest cord, and piece in front of that; -INFINITY */
  float through;          /* sum of depths where the ray goes into pieces, less those where out */
  int piece;              /* that the surface belongs to; -1: none */
  int16_t inside;         /* how many times more it goes in than out */
  int16_t colour;         /* of the cord; -1: none */
  signed char normal[3];  /* of the surface: right, up, to the eye; 127 = 1 */
  signed char rounded[3]; /* of the cord */
} thr_sample;

/* Some rows of samples. */
typedef struct {
  thr_sample *sample; /* [width * (end - begin)] */
  int width, begin, end;
} thr_band;

/* A corner of a triangle: sample and its parts, from the picture's upper left corner. */
typedef struct {
  int at[2];
  float depth, normal[3];
} thr_spot;

/* Returns whether a triangle's outside is seen. */
static inline bool thr_is_front(const thr_spot spot[3])
{
  const int *a = spot[0].at, *b = spot[1].at, *c = spot[2].at;
  return (int64_t)(b[0] - a[0]) * (c[1] - a[1]) < (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
}

/* Fills a triangle, counter-clockwise if it is seen from outside, of a piece, or, piece < 0, of a
 * cord of a colour. Pieces come after all cords. O(samples in its box). */
void thr_band_fill(thr_band *band, const thr_spot spot[3], int piece, int colour);

/* How samples are coloured. */
typedef struct {
  const double (*colour)[3]; /* of cords: red, green, blue, 0 to 1 */
  bool opaque;
  int marked;                          /* as in thr_kit_stage_options */
  double width;                        /* of an arm, mm: what light can go through */
  float clay[64][64][3], cord[64][64]; /* what a normal looks like, by right and up */
} thr_look;

/* Sets what normals look like. up: the world's up as the camera sees it, right, up, to the eye. */
void thr_look_make(thr_look *look, const double up[3]);

/* The colour of the piece that is marked: red, green, blue, 0 to 1. */
static const double THR_MARKED[3] = {0.0, 0.62, 0.45};

/* Adds the colour of a sample in row y of the band to a sum; ground: what is behind, 0 to 1. */
void thr_look_at(const thr_look *look, const thr_band *band, int x, int y, double ground,
                 double sum[3]);

/* ---- picture_png.c ---- */

/* Appends a PNG (ISO/IEC 15948) of pixel[3 * width * height], row by row from the top. */
thr_status thr_png_write(const unsigned char *pixel, const int size[2], thr_text *png,
                         thr_err *err) THR_MUST_CHECK;

/* 256 colours, red, green and blue; number 0 is kept for pixels that an animation leaves as they
 * are. */
typedef struct {
  unsigned char colour[256][3];
} thr_png_palette;

/* The same of index[width * height], numbers of colours. */
thr_status thr_png_write_indexed(const unsigned char *index, const int size[2],
                                 const thr_png_palette *palette, thr_text *png,
                                 thr_err *err) THR_MUST_CHECK;

/* A PNG that moves (APNG, in PNG's third edition): programs that do not know of that show the first
 * picture. Each further picture is the box of what changed. */
typedef struct {
  int size[2];
  uint32_t written;    /* chunks that are numbered */
  unsigned char *last; /* [width * height] the picture before; owned */
  thr_text *png;       /* borrowed */
} thr_apng;

/* Begins an animation of so many pictures, each of which is then added in turn, with the seconds,
 * below 65, for which it is shown; pictures are numbers of colours, 1 to 255. It is played for
 * ever. THR_ENOMEM: png is not whole then. Release with thr_apng_destroy, after a failure too. */
thr_status thr_apng_begin(thr_apng *apng, const int size[2], int n_pictures,
                          const thr_png_palette *palette, thr_text *png,
                          thr_err *err) THR_MUST_CHECK;
thr_status thr_apng_add(thr_apng *apng, const unsigned char *index, double seconds,
                        thr_err *err) THR_MUST_CHECK;
thr_status thr_apng_end(thr_apng *apng, thr_err *err) THR_MUST_CHECK;
void thr_apng_destroy(thr_apng *apng);

#endif
