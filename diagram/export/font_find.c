/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the font files of the four faces with fontconfig, in a child process.
 *
 * fontconfig ends the program when memory runs out, or loops for ever; in a child both are an error
 * of this program. The child answers with two lines for each face, "index name" and the path.
 * fontconfig is loaded when it is first used.
 *
 * Example of an answer: "0 DejaVuSans\n/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf\n", four
 * times. */
#define _XOPEN_SOURCE 700
#include "diagram/export/paper.h"

#include "graph/process/process.h"

#include <fontconfig/fontconfig.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#ifdef __SANITIZE_ADDRESS__
/* fontconfig keeps what it has read of fonts until the process ends, where the leak checker cannot
 * see it. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

const char *__lsan_default_suppressions(void)
{
  return "leak:libfontconfig";
}

const char *__lsan_default_options(void)
{
  return "print_suppressions=0";
}
#endif

#define FUNCTIONS(F)                                                                               \
  F(FcConfigSubstitute)                                                                            \
  F(FcDefaultSubstitute)                                                                           \
  F(FcFontSetDestroy)                                                                              \
  F(FcFontSort)                                                                                    \
  F(FcNameParse)                                                                                   \
  F(FcPatternDestroy)                                                                              \
  F(FcPatternGetInteger)                                                                           \
  F(FcPatternGetString)

static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

/* Ends this process if it takes MOST seconds of processor time more: fontconfig without memory
 * tries for ever. */
static void bound_time(void)
{
  enum { MOST = 10 };
  struct rusage used;

  struct rlimit limit;
  if (getrusage(RUSAGE_SELF, &used) || getrlimit(RLIMIT_CPU, &limit)) return;

  /* The limit counts from the start of the process. */
  rlim_t end = (rlim_t)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + MOST;

  if (limit.rlim_max != RLIM_INFINITY && limit.rlim_max < end) return; /* somebody was stricter */
  limit.rlim_cur = end;
  setrlimit(RLIMIT_CPU, &limit);
}

/* Appends where a font is, "index name<newline>path<newline>", if its outlines are TrueType.
 * Returns whether it did. */
static bool tell(FcPattern *font, thr_text *out)
{
  FcChar8 *path = NULL, *format = NULL, *name = NULL;
  int index = 0;
  char plain[64] = "Font";

  /* Fonts without a file or with other outlines are passed over, and paths that would break the
   * answer. */
  if (lib.FcPatternGetString(font, FC_FILE, 0, &path) != FcResultMatch) return false;
  if (lib.FcPatternGetString(font, FC_FONTFORMAT, 0, &format) != FcResultMatch ||
      strcmp((char *)format, "TrueType") != 0)
    return false;
  if (strchr((char *)path, '\n')) return false;

  if (lib.FcPatternGetInteger(font, FC_INDEX, 0, &index) != FcResultMatch) index = 0;

  /* Of the name only what may stand in a PDF name without escapes. */
  if (lib.FcPatternGetString(font, FC_POSTSCRIPT_NAME, 0, &name) == FcResultMatch) {
    size_t n = 0;
    for (const char *c = (char *)name; *c && n + 1 < sizeof plain; c++)
      if (strchr("-0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", *c))
        plain[n++] = *c;

    plain[n] = '\0';
  }

  /* The lower 16 bits are the font's index in a collection; variants of it are above them. */
  thr_text_printf(out, "%d %s\n%s\n", index & 0xffff, *plain ? plain : "Font", (char *)path);
  return true;
}

/* Appends the best TrueType font for a fontconfig pattern such as "DejaVu Sans:bold". */
static thr_status find_face(const char *words, thr_text *out, thr_err *err)
{
  FcResult result = FcResultMatch;
  FcPattern *pattern = lib.FcNameParse((const FcChar8 *)words);
  if (!pattern || !lib.FcConfigSubstitute(NULL, pattern, FcMatchPattern)) return thr_nomem(err);

  /* What the pattern leaves open comes from the system's configuration. */
  lib.FcDefaultSubstitute(pattern);

  /* Sorted by likeness: the first one with TrueType outlines is taken. */
  FcFontSet *set = lib.FcFontSort(NULL, pattern, FcFalse, NULL, &result);
  bool found = false;
  for (int i = 0; set && i < set->nfont && !found; i++)
    found = tell(set->fonts[i], out);

  if (set) lib.FcFontSetDestroy(set);
  lib.FcPatternDestroy(pattern);

  /* Without a set there was no memory; with one there may be no such font. */
  if (out->failed || (!set && result == FcResultOutOfMemory)) return thr_nomem(err);
  return found ? THR_OK
               : thr_fail(err, THR_ESOLVER,
                          "no TrueType font was found for the words of the PDF; install one, as "
                          "fonts-dejavu-core");
}

/* Finds all faces; runs in the child and sends the answer to the parent. */
static thr_status find_faces(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  static const char *const face[THR_FACES] = {"DejaVu Sans:style=Book", "DejaVu Sans:bold",
                                              "DejaVu Sans Mono:style=Book",
                                              "DejaVu Sans Mono:bold"};

  thr_text out = {0};
  (void)user;
  (void)limits;

  /* In a child, so that only this process ends when fontconfig runs out of memory. */
  bound_time();
  thr_status st = thr_lazy_load(&lib.loaded, THR_LIBRARY_FONTCONFIG, symbol,
                                sizeof symbol / sizeof *symbol, err);

  /* In the order of THR_FACE_BOLD and THR_FACE_MONO: regular, bold, mono, bold mono. */
  for (int i = 0; i < THR_FACES && !st; i++)
    st = find_face(face[i], &out, err);
  if (!st) st = thr_child_send(to, &out, err);

  thr_text_destroy(&out);
  return st;
}

/* Returns the next line of an answer and moves behind it, or NULL if there is none. */
static char *next_line(char **left)
{
  char *line = *left, *end = line ? strchr(line, '\n') : NULL;
  if (!end) return NULL;
  *end = '\0';
  *left = end + 1;
  return line;
}

/* Returns whether all faces are of the family that was asked for. */
static bool is_family(const thr_text *answer)
{
  int n = 0;

  for (const char *at = answer->data; at && (at = strstr(at, " DejaVuSans")); at++)
    n++;
  return n == THR_FACES;
}

/* Asks a child for the faces. Where an allocation fails, fontconfig answers with another family
 * without a word: an answer of that kind is believed only the second time. */
static thr_status ask(thr_text *answer, thr_err *err)
{
  const thr_child child = {.what = "finding fonts for the PDF",
                           .advice = "free memory, or draw without it (-T svg)",
                           .run = find_faces};

  /* Finding fonts takes a moment: no limit of the work's time is passed on. */
  const thr_limits none = {0};
  thr_status st = thr_child_run(&child, &none, answer, err);

  /* The usual case: all four faces are of the family asked for. */
  if (st || is_family(answer)) return st;
  thr_text_destroy(answer);
  return thr_child_run(&child, &none, answer, err);
}

thr_status thr_fonts_find(thr_font *font, thr_err *err)
{
  thr_text answer = {0};
  thr_status st = ask(&answer, err);
  char *left = answer.data;

  for (int i = 0; i < THR_FACES && !st; i++) {
    char *head = next_line(&left), *path = next_line(&left), name[64];
    int index;

    /* Two lines for each face, in the order of faces; the name is what the PDF calls the font. */
    if (!head || !path || sscanf(head, "%d %63s", &index, name) != 2)
      st = thr_fail(err, THR_ESOLVER, "no fonts were found for the PDF");
    else
      st = thr_font_read(&font[i], path, index, name, err);
  }

  thr_text_destroy(&answer);
  return st;
}
