/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Knows the names and sizes of pages, upright, in mm. */
#include "diagram/export/paper.h"

const char *thr_page_name(int s)
{
  static const char *const name[] = {"a4", "letter"};

  return name[s];
}

void thr_page_mm(thr_page_size s, double size[2])
{
  /* ISO 216, and ANSI/ASME Y14.1 size A: 8.5 by 11 inches. */
  static const double mm[][2] = {{210, 297}, {215.9, 279.4}};

  for (int i = 0; i < 2; i++)
    size[i] = mm[s][i];
}
