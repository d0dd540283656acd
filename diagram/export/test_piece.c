/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the piece in which a cord's friction is measured: a bore that turns by 90 degrees, as in a
 * bead with two arms, as a drawing to drill a block by and as a mesh to print.
 *
 * A weight hangs from one end of the cord; a spring balance draws the other end level. By the
 * capstan equation the pull that just draws the weight up and the pull that just lets it slip down
 * are W exp(mu pi / 2) and W exp(-mu pi / 2), so that mu = ln(IN / OUT) / pi.
 *
 * The mesh has three stations: the end of the arm along x, the mitre at the corner, the end of the
 * arm along y. At each of them 16 points lie on the bore and 16 on the square around it;
 * quadrilaterals between them, two strips of each and a ring at both ends, make a closed surface of
 * 192 triangles. */
#include "diagram/export/paper.h"
#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

enum { SIDES = 16, STATIONS = 3 }; /* of the bore; along it */
static const double ARM = 25;      /* mm from the corner to an end */

/* ---- the drawing ---- */

/* Appends a line of text with its base line at (x, y), mm. */
static void put_words(thr_text *svg, double x, double y, const char *words)
{
  thr_text_printf(svg, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"3.2\">%s</text>\n", x, y, words);
}

void thr_test_piece_svg(double bore, thr_text *svg)
{
  const double x = 75, y = 25, side = 30, middle = side / 2;
  char words[120];

  thr_svg_open(svg, 140, 120, "A test piece for the friction of a cord",
               "A block with two bores that meet at a right angle, 1:1.");

  /* Styles, paper and the block seen from the side. */
  thr_text_append(svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}"
                       ".block{fill:#f3e6b8;stroke:#222;stroke-width:.35}.bore{fill:none;stroke:#"
                       "222;stroke-width:.2;stroke-dasharray:1.5 1}"
                       ".cord{fill:none;stroke:#d55e00;stroke-width:.8}</style>\n");

  thr_text_append(svg, "<rect width=\"140\" height=\"120\" fill=\"#fff\"/>\n");
  thr_text_printf(svg,
                  "<rect class=\"block\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  x, y, side, side);

  /* The two sides of both bores, dashed, up to where they meet. */
  for (int k = -1; k <= 1; k += 2) {
    const double off = k * bore / 2;
    thr_text_printf(svg, "<path class=\"bore\" d=\"M%.2f %.2fH%.2fM%.2f %.2fV%.2f\"/>\n", x,
                    y + middle + off, x + middle, x + middle + off, y + side, y + middle);
  }

  /* The cord comes in level from the left and hangs down. */
  thr_text_printf(svg, "<path class=\"cord\" d=\"M%.2f %.2fH%.2fV%.2f\"/>\n", x - 22, y + middle,
                  x + middle, y + side + 32);

  /* What to drill, and what to hang and draw where. */
  snprintf(words, sizeof words, "drill both bores %.2f mm wide, until they meet;", bore);
  put_words(svg, 5, 8, words);
  put_words(svg, 5, 13, "or print the STL. Break no edge that the pieces of the dome keep.");
  put_words(svg, 5, y + middle - 9, "draw level with a spring balance:");
  put_words(svg, 5, y + middle - 4, "IN just draws the weight up,");
  put_words(svg, 5, y + middle + 6, "OUT just lets it slip down");
  put_words(svg, x + middle + 3, y + side + 30, "hang a weight here: HANG");

  /* A ruler shows whether the printer kept the size. */
  thr_text_printf(svg, "<path class=\"block\" d=\"M10 112h50M10 110.5v3M60 110.5v3\"/>\n");
  put_words(svg, 63, 113, "50 mm, if printed true to size");

  thr_text_append(svg, "</svg>\n");
}

/* ---- the mesh ---- */

/* Computes point k of the bore (k < SIDES), or of the square around it, in the plane of a station:
 * out[0] towards the inner side of the bend, out[1] upwards, mm. */
static void profile(double bore, int k, double out[2])
{
  const double angle = 2 * THR_PI * (k % SIDES) / SIDES, cosine = cos(angle), sine = sin(angle),
               half = fmax(5, 1.5 * bore);

  /* A square is where the larger of the two coordinates is half its side. */
  const double size = k < SIDES ? bore / 2 : half / fmax(fabs(cosine), fabs(sine));
  out[0] = size * cosine;
  out[1] = size * sine;
}

/* Computes point k of a station in space, mm. At the mitre the offset counts along both arms. */
static void corner(double bore, int station, int k, double out[3])
{
  double offset[2];
  profile(bore, k, offset);

  out[0] = station == 0 ? ARM : offset[0];
  out[1] = station == 2 ? ARM : offset[0];
  out[2] = offset[1];
}

/* Appends a facet with its unit normal, by the right-hand rule from a, b, c. */
static void put_triangle(thr_text *stl, const double a[3], const double b[3], const double c[3])
{
  double side[3], other_side[3], normal[3];

  /* Two sides of the triangle; their cross product is its normal. */
  for (int k = 0; k < 3; k++) {
    side[k] = b[k] - a[k];
    other_side[k] = c[k] - a[k];
  }

  for (int k = 0; k < 3; k++)
    normal[k] =
        side[(k + 1) % 3] * other_side[(k + 2) % 3] - side[(k + 2) % 3] * other_side[(k + 1) % 3];

  /* STL wants a normal of length 1. */
  const double size = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  thr_text_printf(stl, "facet normal %.6f %.6f %.6f\nouter loop\n", normal[0] / size,
                  normal[1] / size, normal[2] / size);

  /* The corners in the order that the normal came from. */
  for (int i = 0; i < 3; i++) {
    const double *vertex = i == 0 ? a : i == 1 ? b : c;
    thr_text_printf(stl, "vertex %.6f %.6f %.6f\n", vertex[0], vertex[1], vertex[2]);
  }
  thr_text_append(stl, "endloop\nendfacet\n");
}

/* Appends two triangles for a quadrilateral whose corners are points k[] of station[], seen
 * clockwise from outside. */
static void put_quad(thr_text *stl, double bore, const int station[4], const int k[4])
{
  double corners[4][3];
  for (int i = 0; i < 4; i++)
    corner(bore, station[i], k[i], corners[i]);

  put_triangle(stl, corners[0], corners[2], corners[1]);
  put_triangle(stl, corners[0], corners[3], corners[2]);
}

void thr_test_piece_stl(double bore, thr_text *stl)
{
  thr_text_append(stl, "solid test-piece\n");

  for (int k = 0; k < SIDES; k++) {
    const int next = (k + 1) % SIDES, out = k + SIDES, out_next = next + SIDES;

    /* Between two stations: a strip of the square outside, one of the bore inside. */
    for (int station = 0; station + 1 < STATIONS; station++) {
      put_quad(stl, bore, (const int[]){station, station, station + 1, station + 1},
               (const int[]){out, out_next, out_next, out});
      put_quad(stl, bore, (const int[]){station, station + 1, station + 1, station},
               (const int[]){k, k, next, next});
    }

    /* At both ends the ring between bore and square. */
    put_quad(stl, bore, (const int[]){0, 0, 0, 0}, (const int[]){k, next, out_next, out});
    put_quad(stl, bore, (const int[]){2, 2, 2, 2}, (const int[]){k, out, out_next, next});
  }

  thr_text_append(stl, "endsolid test-piece\n");
}
