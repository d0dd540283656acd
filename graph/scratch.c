/* Arrays in a list, the last one first. */
#include "graph/scratch.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

struct thr_scratch_array {
  struct thr_scratch_array *before;
  max_align_t data[];
};

void *thr_scratch_array(thr_scratch *s, size_t n, size_t size)
{
  const size_t head = sizeof(struct thr_scratch_array);
  struct thr_scratch_array *made = NULL;
  if (!s->failed && n <= (SIZE_MAX - head) / (size ? size : 1)) made = thr_calloc(1, head + n * size);
  s->failed = !made;
  if (!made) return NULL;
  made->before = s->last;
  s->last = made;
  return made->data;
}

thr_status thr_scratch_check(const thr_scratch *s, thr_err *err)
{
  return s->failed ? thr_nomem(err) : THR_OK;
}

void thr_scratch_free(thr_scratch *s)
{
  while (s->last) {
    struct thr_scratch_array *before = s->last->before;
    free(s->last);
    s->last = before;
  }
  s->failed = false;
}
