/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disjoint sets in an array of parents (parent[v] == v: a root), with path halving; the lowest
 * member stays root. */
#ifndef THR_DISJOINT_H
#define THR_DISJOINT_H

static inline int thr_disjoint_find(int *parent, int v)
{
  while (parent[v] != v)
    v = parent[v] = parent[parent[v]];
  return v;
}

/* Joins the sets of a and b; returns 0 if they were one set already, else 1. */
static inline int thr_disjoint_join(int *parent, int a, int b)
{
  a = thr_disjoint_find(parent, a);
  b = thr_disjoint_find(parent, b);
  if (a == b) return 0;
  parent[a < b ? b : a] = a < b ? a : b;
  return 1;
}

/* number[n] receives the number of the set of each member of parent[n], in the order of the sets'
 * lowest members; returns how many there are. number may be parent itself, which is no forest any
 * more then. */
static inline int thr_disjoint_number(int *parent, int n, int *number)
{
  int count = 0;
  for (int v = 0; v < n; v++)
    number[v] = thr_disjoint_find(parent, v);
  for (int v = 0; v < n; v++) /* roots are the lowest of their sets, so their numbers are known */
    number[v] = number[v] == v ? count++ : number[number[v]];
  return count;
}

#endif
