/* The events of a search: a radix heap (Ahuja, Mehlhorn, Orlin and Tarjan, "Faster algorithms for the shortest path problem", J.
 * ACM 37, 1990), for no event is due before the one that led to it. Bucket 0 has what is due at s->queue_time, bucket k what
 * differs from that time in bit k - 1 and no higher one. Moving a bucket down reads memory in order; a heap does not. */
#include "graph/status.h"
#include "lp/matching/blossom_parts.h"

static int bucket_of(const thr_matching_state *s, int64_t time)
{
  uint64_t differ = (uint64_t)(time ^ s->queue_time);
  return differ ? 64 - __builtin_clzll(differ) : 0;
}

static void put(thr_matching_state *s, blossom_event e)
{
  int k = bucket_of(s, e.time);
  blossom_bucket *to = &s->bucket[k];
  if (to->count == to->capacity && !s->status) s->status = thr_grow(&to->event, to->count, &to->capacity, sizeof e, s->err);
  if (s->status) return;
  to->event[to->count++] = e;
  s->filled |= UINT64_C(1) << k;
}

void thr_blossom_push(thr_matching_state *s, int64_t time, int dart)
{
  if (time < s->end_time) put(s, (blossom_event){time, dart});
}

int64_t thr_blossom_due(thr_matching_state *s)
{
  if (!s->filled) return s->end_time;
  int k = __builtin_ctzll(s->filled);
  blossom_bucket *from = &s->bucket[k];
  if (k) {
    int64_t least = from->event[0].time;
    for (int i = 1; i < from->count; i++)
      if (from->event[i].time < least) least = from->event[i].time;
    if (least >= s->end_time) return s->end_time;
    s->queue_time = least;
    int count = from->count;
    from->count = 0;
    s->filled &= s->filled - 1;
    for (int i = 0; i < count; i++)
      put(s, from->event[i]);
  }
  return s->queue_time < s->end_time ? s->queue_time : s->end_time;
}

int thr_blossom_pop(thr_matching_state *s)
{
  blossom_bucket *from = &s->bucket[0];
  if (from->count == 1) s->filled &= ~UINT64_C(1);
  return from->event[--from->count].dart;
}

void thr_blossom_reset(thr_matching_state *s)
{
  for (; s->filled; s->filled &= s->filled - 1)
    s->bucket[__builtin_ctzll(s->filled)].count = 0;
  s->time = s->queue_time = 0;
  s->end_time = INT64_MAX;
  s->end_dart = -1;
}
