/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Letters of single strokes, which a printer's nozzle can follow: capitals, digits, a hyphen, an
 * arrow.
 *
 * A letter stands on a grid of 4 by 6 squares, its corners numbered by two digits, x then y from
 * below; strokes are lines through such corners, separated by blanks. */
#include "kit/kit.h"

#include <ctype.h>
#include <string.h>

static const double HIGH = 6, ADVANCE = 5.6; /* squares: of a capital; from letter to letter */

/* Strokes of a letter. Small letters are written as capitals. */
static const struct {
  char letter;
  const char *strokes;
} shapes[] = {
    {'A', "002640 0232"},
    {'B', "0006263533 0333 42 41300000 3342"},
    {'C', "4536160501103041"},
    {'D', "000626443020 2000"},
    {'E', "40000646 0333"},
    {'F', "000646 0333"},
    {'G', "453616050110304143 4323"},
    {'H', "0006 4046 0343"},
    {'I', "2026"},
    {'J', "0110304146"},
    {'K', "0006 4602 1340"},
    {'L', "060040"},
    {'M', "0006234640"},
    {'N', "00064046"},
    {'O', "1030414536160501 0110"},
    {'P', "00062646440303"},
    {'Q', "1030414536160501 0110 2240"},
    {'R', "000636454433 3303 2340"},
    {'S', "4536160504 04134241 41301001"},
    {'T', "2026 0646"},
    {'U', "060110304146"},
    {'V', "062046"},
    {'W', "0610233046"},
    {'X', "0046 0640"},
    {'Y', "062346 2320"},
    {'Z', "06460040"},
    {'0', "1030414536160501 0110 0145"},
    {'1', "052620 1030"},
    {'2', "05163645440040"},
    {'3', "051636454433 3313 334241301001"},
    {'4', "30360242"},
    {'5', "46060333 334241301001"},
    {'6', "3616050110304142331303"},
    {'7', "064620"},
    {'8', "130405163645443313 130201103041423313"},
    {'9', "1030414536160504133343"},
    {'-', "1333"},
    {'>', "0343 2543 2143"},
    {'.', "2021"},
    {'_', "0040"},
    {'/', "0046"},
    {'+', "0343 2125"},
};

static const char box[] = "0006464000";

/* Returns the strokes of a letter. */
static const char *strokes_of(char letter)
{
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (shapes[i].letter == toupper((unsigned char)letter)) return shapes[i].strokes;
  return letter == ' ' ? "" : box;
}

int thr_kit_strokes(const char *words, double height, thr_kit_stroke *stroke, int most,
                    double *room)
{
  double square = height / HIGH, at = 0;
  int n = 0;

  for (; *words; words++) {
    /* A letter of several bytes is one box. */
    if (thr_text_is_inside(*words)) continue;
    const char *path = strokes_of(*words);
    for (; path[0] && path[1]; path += 2) {
      if (path[0] == ' ') {
        path--;
        continue;
      }
      if (!path[2] || path[2] == ' ' || !path[3]) continue;
      if (stroke && n < most)
        stroke[n] = (thr_kit_stroke){
            .from = {at + (path[0] - '0') * square, (path[1] - '0' - HIGH / 2) * square},
            .to = {at + (path[2] - '0') * square, (path[3] - '0' - HIGH / 2) * square}};
      n++;
    }
    at += ADVANCE * square;
  }
  *room = at - (at > 0 ? (ADVANCE - 4) * square : 0);

  return n;
}
