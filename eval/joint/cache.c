/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stores measured joints as small text files in a folder, one file per joint, and reads them back.
 * A file is named by a hash of its key and holds the key, so that a collision of hashes is only a
 * miss. A file that is corrupt, truncated, of another key or unreadable counts as absent: the joint
 * is measured again. What a file looks like: thr_cache_write. */
#include "eval/joint/joint.h"
#include "eval/joint/world.h"
#include "graph/os.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_FILE = 4096, MAX_VALUES = 512 };

/* Returns the hash FNV-1a of n bytes, 64 bits (G. Fowler, L. C. Noll, K.-P. Vo). */
static uint64_t fnv1a(const char *bytes, size_t n)
{
  uint64_t hash = 14695981039346656037u;
  for (size_t i = 0; i < n; i++)
    hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211u;
  return hash;
}

void thr_cache_key(const thr_drag *drag, thr_text *key)
{
  assert(drag->n_turns == 1);

  /* What made the number: program, protocol, library. */
  thr_text_printf(key, "joint measured by thread\nprotocol %s\nbullet %d\n", thr_drag_protocol(),
                  thr_bullet_version());

  /* What was asked: the joint, and how it was simulated. */
  thr_text_printf(key, "turn %.17g\ntwist %.17g\nsegment %.17g\nbore %.17g\nmu %.17g\n",
                  drag->turn[0], drag->twist ? drag->twist[0] : 0, drag->segment, drag->bore,
                  drag->mu);
  thr_text_printf(key,
                  "seed %" PRIu64 "\ntime_step %.17g\niterations %.17g\nspacing %.17g\nsides %d\n",
                  drag->seed, drag->time_step, drag->iterations, drag->spacing, drag->sides);
}

/* Example of a file, joint-0123456789abcdef.txt:
 *
 *   joint measured by thread         the key: everything that the result depends on
 *   protocol spheres 0.2 apart ..
 *   turn 1.5707963267948966 ..
 *   status 0                         the values, with 17 digits
 *   ratio 1.17 ..
 *   check 0123456789abcdef           FNV-1a of all bytes before */
void thr_cache_write(const thr_text *key, const thr_drag_result *result, thr_text *out)
{
  size_t begin = out->length;

  if (key->failed) out->failed = true;
  thr_text_append_bytes(out, key->data, key->length);

  /* 17 digits make a double exact. */
  thr_text_printf(
      out, "status %d\nratio %.17g\ndrift %.17g\nscatter %.17g\ntaut %.17g\nsteps %.17g\n",
      result->status, result->ratio, result->drift, result->scatter, result->taut, result->steps);

  /* The checksum covers key and values. */
  if (!out->failed)
    thr_text_printf(out, "check %016" PRIx64 "\n", fnv1a(out->data + begin, out->length - begin));
}

static bool finite_result(const thr_drag_result *result)
{
  return isfinite(result->ratio) && isfinite(result->drift) && isfinite(result->scatter) &&
         isfinite(result->taut) && isfinite(result->steps);
}

bool thr_cache_parse(const char *text, size_t n, const thr_text *key, thr_drag_result *out)
{
  /* The file must begin with the key, and the rest must fit. */
  char values[MAX_VALUES];
  if (key->failed || n <= key->length || n - key->length >= sizeof values) return false;

  if (memcmp(text, key->data, key->length) != 0) return false;

  /* sscanf needs a NUL. */
  memcpy(values, text + key->length, n - key->length);
  values[n - key->length] = 0;

  thr_drag_result result;

  /* Read the status as a double: an integer of any length would overflow %d. */
  double status;
  if (sscanf(values, "status %lf ratio %lf drift %lf scatter %lf taut %lf steps %lf", &status,
             &result.ratio, &result.drift, &result.scatter, &result.taut, &result.steps) != 6)
    return false;
  if (status != THR_DRAG_SETTLED && status != THR_DRAG_UNSETTLED && status != THR_DRAG_OUT_OF_RANGE)
    return false;

  result.status = (int)status;
  if (!finite_result(&result)) return false;

  /* Writing it again covers spelling, order, checksum and what may follow. */
  thr_text again = {0};
  thr_cache_write(key, &result, &again);
  bool same = !again.failed && again.length == n && memcmp(again.data, text, n) == 0;
  thr_text_destroy(&again);

  if (same) *out = result;
  return same;
}

/* Writes the path of the file for a key; false if memory ran out. */
static bool file_name(const char *folder, const thr_text *key, thr_text *path)
{
  if (key->failed) return false;
  thr_text_printf(path, "%s/joint-%016" PRIx64 ".txt", folder, fnv1a(key->data, key->length));
  return !path->failed;
}

bool thr_cache_load(const char *folder, const thr_drag *drag, thr_drag_result *out)
{
  /* A file larger than MAX_FILE is not one of ours. */
  char data[MAX_FILE];
  thr_text key = {0}, path = {0};
  bool found = false;

  thr_cache_key(drag, &key);
  if (file_name(folder, &key, &path)) {
    int n = thr_os_read_small(path.data, data, MAX_FILE);
    found = n >= 0 && thr_cache_parse(data, (size_t)n, &key, out);
  }

  thr_text_destroy(&key);
  thr_text_destroy(&path);
  return found;
}

/* Makes the folders that a path names, from the outermost one on. What cannot be made shows when
 * the file is written. */
static void make_folders(char *path)
{
  for (char *c = path + 1; *c; c++) {
    if (!thr_os_is_separator(*c)) continue;
    const char separator = *c;

    /* End the path here for a moment. */
    *c = 0;
    (void)thr_os_make_folder(path);
    *c = separator;
  }
}

thr_status thr_cache_store(const char *folder, const thr_drag *drag, const thr_drag_result *result,
                           thr_err *err)
{
  thr_text key = {0}, path = {0}, text = {0};
  thr_status st;

  thr_cache_key(drag, &key);
  thr_cache_write(&key, result, &text);

  /* Each failure has its own text: the value, memory, the folder. */
  if (!finite_result(result))
    st = thr_fail(err, THR_EINPUT, "a measurement that is not finite is not kept");
  else if (!file_name(folder, &key, &path))
    st = thr_nomem(err);
  else {
    make_folders(path.data);
    if (thr_os_is_no_file(path.data))
      st = thr_fail(err, THR_EIO, "%s: is not a file; remove it", path.data);
    else
      st = thr_text_write(&text, path.data, err);
  }

  thr_text_destroy(&key);
  thr_text_destroy(&path);
  thr_text_destroy(&text);
  return st;
}
