/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes README.txt of a kit's folder: what each file is for, how many of what to print, and what a
 * printer has to be told: layers, material, supports.
 *
 * A layer is no higher than a sixth of the thinnest wall, and at most 0.2 mm, which printers with a
 * nozzle of 0.4 mm lay as a rule. Supports are for the pieces on whose lower sides more than an
 * arm's section hangs over.
 *
 * Example: "X-13-print-4x.stl ..: print 4 of it". */
#include "kit/files.h"

#include "graph/number.h"

#include <math.h>
#include <stdio.h>

/* Appends a line of the list of files. */
static void put_file(thr_text *out, const char *name, const char *what)
{
  thr_text_printf(out, "  %-18s %s\n", name, what);
}

/* Appends the files with the plates: one, or one for each. */
static void put_plates(const thr_kit_plates *plates, thr_text *out)
{
  const double *bed = plates->kit->options.bed;
  char name[32] = "kit.3mf";
  if (plates->n_plates > 1) snprintf(name, sizeof name, "kit-1 .. kit-%d.3mf", plates->n_plates);
  thr_text_printf(out, "  %-18s all pieces as they stand on a bed of %g x %g mm: print %s once\n",
                  name, bed[0], bed[1], plates->n_plates > 1 ? "each" : "it");
}

/* Returns how many pieces hang over so much that they need supports. */
static int count_hanging(const thr_kit_plates *plates)
{
  const thr_kit *kit = plates->kit;
  int n = 0;
  for (int p = 0; p < kit->n_pieces; p++) {
    const double width = kit->options.width;
    n += plates->stand[kit->piece[p].like].overhang > 0.25 * THR_PI * width * width;
  }
  return n;
}

void thr_kit_read_me(const thr_kit_plates *plates, const thr_kit_written *written, thr_text *out)
{
  const thr_kit *kit = plates->kit;
  const int hanging = count_hanging(plates);
  const char *word = thr_pieces_word(kit->plan, kit->n_pieces);

  /* What there is, in the words of the command and of the booklet. */
  thr_text_printf(out, "%d %s to print, ", kit->n_pieces, word);
  thr_kit_kinds(kit, out);
  thr_text_printf(out, ", %.0f g of a material of %.3g g/cm3.\n\n", kit->mass,
                  kit->options.density);

  /* The files. */
  put_plates(plates, out);
  if (written->stl)
    put_file(out, "*-print-Nx.stl",
             "instead of that, a file for each kind, flat on its best side: "
             "print N of it");
  if (written->scad) put_file(out, "kit.scad", "the same pieces for OpenSCAD, to be changed");
  if (kit->piece[0].tube) put_file(out, "tubes.csv", "what to saw, if the tubes are not printed");
  put_file(out, "kit.csv", "a row for each piece: name, size, mass, thinnest wall, plate");
  if (written->pictures)
    put_file(out, "kit.png, kit.html", "what it will look like; the steps in any browser");

  /* What the printer has to know. Sizes are true: nothing is to be scaled. */
  thr_text_printf(out,
                  "\nMaterial: any that prints well, as PLA. Sizes are in mm: do not scale.\n"
                  "Layers: %.2g mm or finer; the thinnest wall is %.3g mm.\n",
                  fmin(0.2, kit->options.wall / 6), kit->options.wall);
  if (hanging)
    thr_text_printf(out,
                    "Supports: on, from the bed only, so that channels stay free; %d of %d %s "
                    "hang over (overhang_mm2 in kit.csv).\n",
                    hanging, kit->n_pieces, word);
  else
    thr_text_append(out, "Supports: none.\n");
  thr_text_printf(out,
                  "Print one piece first and draw the cord, %.3g mm thick, through its channels.\n",
                  kit->cord);
}
