/* SPDX-License-Identifier: GPL-3.0-or-later */
/* make validate: docs/validation.md. Exit code 1 if a value is outside its bound. Usage: validate
 * FILE [part] */
#include "eval/joint/joint.h"
#include "eval/joint/world.h"
#include "tests/validate/validate.h"

#include <stdio.h>
#include <string.h>

static const struct {
  const char *name;
  thr_status (*run)(report *, thr_err *);
} part[] = {{"joint", validate_joint},
            {"cord", validate_cord},
            {"mitre", validate_mitre},
            {"cantilever", validate_cantilever},
            {"ranking", validate_ranking}};

int main(int argc, char **argv)
{
  report r = {0};
  thr_err err = {0};
  thr_status st = THR_OK;
  if (argc < 2 || argc > 3) {
    fprintf(stderr, "usage: %s FILE [part]\n", argv[0]);
    return 2;
  }
  thr_text_printf(&r.text,
                  "# Validation of the pull force\n\nWritten by `make validate`, which fails if a "
                  "value is outside its bound. "
                  "Every case that was "
                  "run is shown.\nBullet %d.%02d, double precision. Protocol of the joint: %s.\n",
                  thr_bullet_version() / 100, thr_bullet_version() % 100, thr_drag_protocol());
  for (size_t i = 0; i < sizeof part / sizeof *part && !st; i++)
    if (argc < 3 || strcmp(argv[2], part[i].name) == 0) {
      fprintf(stderr, "%s ..\n", part[i].name);
      st = part[i].run(&r, &err);
    }
  if (!st) {
    thr_text_printf(&r.text, "\n%d values, %d outside their bound.\n", r.rows, r.outside);
    st = thr_text_write(&r.text, argv[1], &err);
  }
  thr_text_destroy(&r.text);
  if (st)
    fprintf(stderr, "%s\n", err.text);
  else
    printf("%d values, %d outside their bound\n", r.rows, r.outside);
  return st || r.outside ? 1 : 0;
}
