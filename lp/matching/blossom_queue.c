/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the events of a search in a radix heap (Ahuja, Mehlhorn, Orlin and Tarjan, "Faster
 * algorithms for the shortest path problem", J. ACM 37, 1990). A radix heap requires that no event
 * is due before the last one taken out, which holds because every event follows from an earlier
 * one.
 *
 * Bucket 0 has the events due at matching_state->queue_time, bucket k those whose time differs from
 * queue_time in bit k - 1 and no higher one. When bucket 0 is empty, the clock moves to the least
 * time of the first bucket that is not, and the events of this bucket move to lower ones. Moving a
 * bucket reads memory in order, which a binary heap does not.
 *
 * Example: at queue_time 4, events at 4, 5 and 6 are in buckets 0, 1 and 2. */
#include "lp/matching/blossom_parts.h"

/* Returns the bucket of an event at this time: 1 plus the highest bit that differs, or 0. */
static int bucket_of(const thr_matching_state *matching_state, int64_t time)
{
  uint64_t differ = (uint64_t)(time ^ matching_state->queue_time);
  return differ ? 64 - __builtin_clzll(differ) : 0;
}

/* Puts an event into its bucket. Out of memory: matching_state->status, and the event is lost. */
static void put(thr_matching_state *matching_state, blossom_event event)
{
  int k = bucket_of(matching_state, event.time);
  blossom_bucket *bucket = &matching_state->bucket[k];
  if (bucket->count == bucket->capacity && !matching_state->status)
    matching_state->status = thr_grow(&bucket->event, bucket->count, &bucket->capacity,
                                      sizeof event, matching_state->err);
  if (matching_state->status) return;

  bucket->event[bucket->count++] = event;
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
  blossom_bucket *bucket = &matching_state->bucket[k];

  /* Move the clock to the least time, unless the search ends before. */
  if (k) {
    int64_t least = bucket->event[0].time;
    for (int i = 1; i < bucket->count; i++)
      if (bucket->event[i].time < least) least = bucket->event[i].time;
    if (least >= matching_state->end_time) return matching_state->end_time;
    matching_state->queue_time = least;

    /* Move the bucket down: every event shares one more bit with the clock now. */
    int count = bucket->count;
    bucket->count = 0;
    matching_state->filled &= matching_state->filled - 1;
    for (int i = 0; i < count; i++)
      put(matching_state, bucket->event[i]);
  }

  return matching_state->queue_time < matching_state->end_time ? matching_state->queue_time
                                                               : matching_state->end_time;
}

int thr_blossom_pop(thr_matching_state *matching_state)
{
  blossom_bucket *bucket = &matching_state->bucket[0];
  if (bucket->count == 1) matching_state->filled &= ~UINT64_C(1);
  return bucket->event[--bucket->count].dart;
}

void thr_blossom_reset(thr_matching_state *matching_state)
{
  /* Visit only the buckets that are not empty. */
  for (; matching_state->filled; matching_state->filled &= matching_state->filled - 1)
    matching_state->bucket[__builtin_ctzll(matching_state->filled)].count = 0;

  matching_state->time = matching_state->queue_time = 0;
  matching_state->end_time = INT64_MAX;
  matching_state->end_dart = -1;
}
