/* SPDX-License-Identifier: MIT
 * Plans a dome with libthread, checks the plan and draws it:
 *   cc dome.c $(pkg-config --cflags --libs thread) -o dome && ./dome dome.svg
 * prints the length of cord in mm, 1995.248611. */
#include <stdio.h>
#include <thread.h>

static thread_status save(const char *path, const char *bytes, size_t n)
{
  FILE *file = fopen(path, "wb");
  if (!file) return THREAD_IO;
  int written = fwrite(bytes, 1, n, file) == n;
  return fclose(file) == 0 && written ? THREAD_OK : THREAD_IO;
}

int main(int argc, char **argv) /* dome [PICTURE.svg] */
{
  thread_error err = {"cannot write the picture"};
  thread_frame *dome;
  thread_plan *plan = NULL;
  thread_summary summary;
  thread_plan_options options;
  char *svg = NULL;
  size_t n;

  thread_plan_options_init(&options, sizeof options);
  options.cords = 1; /* the one shortest; without a number, what a hand can pull */

  thread_status st = thread_frame_shape("dome", 7, &dome, &err);
  if (!st) st = thread_plan_make(dome, &options, &plan, &err);
  if (!st) st = thread_check(plan, &err);
  if (!st) st = thread_plan_summary(plan, &summary, sizeof summary, &err);
  if (!st) printf("%.6f\n", summary.length);
  if (!st && argc > 1) st = thread_draw(plan, "svg", &svg, &n, &err);
  if (!st && argc > 1) st = save(argv[1], svg, n);
  if (st) fprintf(stderr, "dome: %s\n", err.text[0] ? err.text : argv[1]);

  thread_free(svg);
  thread_plan_free(plan);
  thread_frame_free(dome);
  return st ? 1 : 0;
}
