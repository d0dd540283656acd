/* Disjoint sets in an array of parents (parent[v] == v: a root), with path halving; the lowest member stays root. */
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

#endif
