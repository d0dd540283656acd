/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The events of a search: a radix heap (Ahuja, Mehlhorn, Orlin and Tarjan, "Faster algorithms for
 * the shortest path problem", J. ACM 37, 1990), for no event is due before the one that led to it.
 * Bucket 0 has what is due at s->queue_time, bucket k what differs from that time in bit k - 1 and
 * no higher one. Moving a bucket down reads memory in order; a heap does not. */
#include "lp/matching/blossom_parts.h"

static int bucket_of(const thr_matching_state *matching_state, int64_t time)
{
  uint64_t differ = (uint64_t)(time ^ matching_state->queue_time);
  return differ ? 64 - __builtin_clzll(differ) : 0;
}

static void put(thr_matching_state *matching_state, blossom_event e)
{
  int k = bucket_of(matching_state, e.time);
  blossom_bucket *to = &matching_state->bucket[k];
  if (to->count == to->capacity && !matching_state->status)
    matching_state->status =
        thr_grow(&to->event, to->count, &to->capacity, sizeof e, matching_state->err);
  if (matching_state->status) return;
  to->event[to->count++] = e;
  matching_state->filled |= UINT64_C(1) << k;
}

void thr_blossom_push(thr_matching_state *matching_state, int64_t time, int dart)
{
  if (time < matching_state->end_time) put(matching_state, (blossom_event){time, dart});
}

int64_t thr_blossom_due(thr_matching_state *matching_state)
{
  if (!matching_state->filled) return matching_state->end_time;
  int k = __builtin_ctzll(matching_state->filled);
  blossom_bucket *from = &matching_state->bucket[k];
  if (k) {
    int64_t least = from->event[0].time;
    for (int i = 1; i < from->count; i++)
      if (from->event[i].time < least) least = from->event[i].time;
    if (least >= matching_state->end_time) return matching_state->end_time;
    matching_state->queue_time = least;
    int count = from->count;
    from->count = 0;
    matching_state->filled &= matching_state->filled - 1;
    for (int i = 0; i < count; i++)
      put(matching_state, from->event[i]);
  }
  return matching_state->queue_time < matching_state->end_time ? matching_state->queue_time
                                                               : matching_state->end_time;
}

int thr_blossom_pop(thr_matching_state *matching_state)
{
  blossom_bucket *from = &matching_state->bucket[0];
  if (from->count == 1) matching_state->filled &= ~UINT64_C(1);
  return from->event[--from->count].dart;
}

void thr_blossom_reset(thr_matching_state *matching_state)
{
  for (; matching_state->filled; matching_state->filled &= matching_state->filled - 1)
    matching_state->bucket[__builtin_ctzll(matching_state->filled)].count = 0;
  matching_state->time = matching_state->queue_time = 0;
  matching_state->end_time = INT64_MAX;
  matching_state->end_dart = -1;
}
