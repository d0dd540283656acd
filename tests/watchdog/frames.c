/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Generators of the frameworks, written out as they are made. */
#include "tests/watchdog/frames.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

static void node(FILE *to, double x, double y, double z)
{
  fprintf(to, "v %.9f %.9f %.9f\n", x, y, z);
}

/* Nodes are numbered from 0 here, from 1 in the file. */
static void edge(FILE *to, int a, int b)
{
  fprintf(to, "l %d %d\n", a + 1, b + 1);
}

/* n nodes on a circle of radius r, turned by a part of a step. */
static void ring(FILE *to, int n, double r, double z)
{
  for (int i = 0; i < n; i++)
    node(to, r * cos(2 * THR_PI * i / n), r * sin(2 * THR_PI * i / n), z);
}

static void star(FILE *to, int n, int unused)
{
  (void)unused;
  node(to, 0, 0, 0);
  for (int i = 0; i < n; i++) {
    double length = 10 + i % 7;
    node(to, length * cos(2 * THR_PI * i / n), length * sin(2 * THR_PI * i / n), 1);
  }
  for (int i = 1; i <= n; i++)
    edge(to, 0, i);
}

static void wheel(FILE *to, int n, int unused)
{
  (void)unused;
  node(to, 0, 0, 3);
  ring(to, n, 10, 0);
  for (int i = 0; i < n; i++) {
    edge(to, 0, 1 + i);
    edge(to, 1 + i, 1 + (i + 1) % n);
  }
}

/* On a spiral around a sphere, so that no two edges have one length. */
static void complete(FILE *to, int n, int unused)
{
  (void)unused;
  for (int i = 0; i < n; i++) {
    double z = 2 * (i + 0.5) / n - 1, r = sqrt(1 - z * z);
    node(to, 100 * r * cos(2.4 * i), 100 * r * sin(2.4 * i), 100 * z);
  }
  for (int i = 0; i < n; i++)
    for (int k = i + 1; k < n; k++)
      edge(to, i, k);
}

/* A path of n nodes, each with `legs` edges that end there. */
static void caterpillar(FILE *to, int n, int legs)
{
  for (int i = 0; i < n; i++) {
    node(to, 10 * i, 0, i % 3);
    for (int k = 0; k < legs; k++)
      node(to, 10 * i + 0.3 * (k + 1), (k % 2 ? 8 : -8) - k, 1);
  }
  for (int i = 0; i < n; i++) {
    for (int k = 1; k <= legs; k++)
      edge(to, i * (legs + 1), i * (legs + 1) + k);
    if (i + 1 < n) edge(to, i * (legs + 1), (i + 1) * (legs + 1));
  }
}

static void grid(FILE *to, int n, int m)
{
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++)
      node(to, 10 * i, 10 * k, 0);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) {
      if (i + 1 < n) edge(to, i * m + k, (i + 1) * m + k);
      if (k + 1 < m) edge(to, i * m + k, i * m + k + 1);
    }
}

/* n components: rings of k nodes, or single edges. */
static void pieces(FILE *to, int n, int k)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < k; j++)
      node(to, 30 * (i % 60) + 10 * cos(2 * THR_PI * j / k),
           30 * (double)(i / 60) + 10 * sin(2 * THR_PI * j / k), 0);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < (k == 2 ? 1 : k); j++)
      edge(to, i * k + j, i * k + (j + 1) % k);
}

/* Planar, with the mirrors and rotations of n spokes: a middle node, `rings` nodes on each spoke,
 * and a ring through every second of those, beginning with the outermost. */
static void web(FILE *to, int n, int rings)
{
  node(to, 0, 0, 0);
  for (int r = 1; r <= rings; r++)
    ring(to, n, 10 * r, 0);
  for (int r = 1; r <= rings; r++)
    for (int i = 0; i < n; i++) {
      int at = 1 + (r - 1) * n + i;
      edge(to, r == 1 ? 0 : at - n, at);
      if ((rings - r) % 2 == 0) edge(to, at, 1 + (r - 1) * n + (i + 1) % n);
    }
}

/* A strip of n hexagons, planar, with two mirrors. */
static void strip(FILE *to, int n, int unused)
{
  (void)unused;
  for (int i = 0; i <= 2 * n; i++) {
    node(to, 8.66 * i, i % 2 ? 15 : 10, 0);
    node(to, 8.66 * i, i % 2 ? -15 : -10, 0);
  }
  for (int i = 0; i <= 2 * n; i++) {
    if (i % 2 == 0) edge(to, 2 * i, 2 * i + 1);
    for (int k = 0; k < 2 && i < 2 * n; k++)
      edge(to, 2 * i + k, 2 * i + 2 + k);
  }
}

static const struct {
  const char *name;
  void (*make)(FILE *to, int n, int m);
  int n, m;
  bool selected;
} frame[] = {
    {"star-5", star, 5, 0, true},
    {"star-300", star, 300, 0, true},
    {"star-5000", star, 5000, 0, true},
    {"wheel-12", wheel, 12, 0, false},
    {"wheel-300", wheel, 300, 0, true},
    {"complete-20", complete, 20, 0, false},
    {"complete-120", complete, 120, 0, true},
    {"complete-300", complete, 300, 0, true},
    {"caterpillar-40x3", caterpillar, 40, 3, true},
    {"caterpillar-1000x4", caterpillar, 1000, 4, false},
    {"grid-6x6", grid, 6, 6, true},
    {"grid-40x40", grid, 40, 40, true},
    {"pieces-3000x2", pieces, 3000, 2, false},
    {"pieces-3000x3", pieces, 3000, 3, true},
    {"web-6x5", web, 6, 5, true},   /* 31 nodes, 48 edges */
    {"web-10x3", web, 10, 3, true}, /* 31 nodes, 50 edges */
    {"web-5x6", web, 5, 6, false},  /* 31 nodes, 45 edges */
    {"strip-7", strip, 7, 0, false} /* 30 nodes, 36 edges */
};

int watchdog_frames(void)
{
  return (int)(sizeof frame / sizeof *frame);
}

const char *watchdog_frame_name(int i)
{
  return frame[i].name;
}

bool watchdog_frame_selected(int i)
{
  return frame[i].selected;
}

bool watchdog_frame_write(int i, const char *path)
{
  FILE *to = fopen(path, "w");
  if (!to) return false;
  frame[i].make(to, frame[i].n, frame[i].m);
  bool sound = !ferror(to);
  return fclose(to) == 0 && sound;
}
