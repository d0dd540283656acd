/* A finite permutation group with all its elements listed, and its subgroups up to conjugacy.
 *
 * Elements are found breadth first from the generators, with a table of products; subgroups by extension: each one is extended
 * by one more element, and one of each class of conjugates is kept (J. Neubueser 1960).
 *
 * Example: the eight elements of the square's group have 10 subgroups in 8 classes. */
#ifndef THR_GROUP_H
#define THR_GROUP_H

#include "graph/status.h"

enum { THR_GROUP_CAP = 1024 }; /* largest order that is listed */

/* Elements are numbered: 0 is the identity, the others in lexicographic order of their images. */
typedef struct {
  int degree; /* points that the group permutes */
  int order;
  int *image;       /* [order * degree] image[g * degree + x] = g(x); owned */
  int *product;     /* [order * order] product[g * order + h] = g after h: x -> g(h(x)); owned */
  int *inverse;     /* [order] owned */
  int *power_order; /* [order] least k > 0 with g^k = 1; owned */
} thr_group;

/* All products of the generators (image lists of length degree, one after the other). THR_ELIMIT: more than cap elements (at most
 * THR_GROUP_CAP); THR_EINPUT: a generator is no permutation; out is then empty. O(order * (n_generators * degree + order)). */
thr_status thr_group_generate(int degree, const int *generator, int n_generators, int cap, thr_group *out,
                              thr_err *err) THR_MUST_CHECK;
void thr_group_destroy(thr_group *group);

/* A set of elements, by number. */
typedef struct {
  int order;
  int *element; /* [order] ascending; owned; element[0] = 0 */
} thr_subgroup;

void thr_subgroup_destroy(thr_subgroup *s);

bool thr_subgroup_has(const thr_subgroup *s, int element); /* O(log order) */

/* A few elements that generate s: greedily, the lowest that is not yet generated. Returns how many: at most 10, since each at
 * least doubles the order. */
int thr_subgroup_generators(const thr_group *group, const thr_subgroup *s, int generator[16]);

/* One representative of every class of conjugate subgroups: by descending order, then by elements. */
typedef struct {
  int n;
  thr_subgroup *subgroup; /* [n] owned */
  int *conjugates;        /* [n] size of its class; owned */
  bool complete;          /* false: the cap on classes stopped it; then mostly small ones are there, and the whole group */
} thr_subgroup_classes;

/* Every subgroup is reached from the trivial one by adding one element at a time; conjugates of those met are kept and
 * recognized. The representative is the first of its class in the order above. At most `most` classes (with 2 or more, the whole
 * group and the trivial one are among them). O(classes * order * (order + order of the subgroups)). */
thr_status thr_subgroup_classes_find(const thr_group *group, int most, thr_subgroup_classes *out, thr_err *err) THR_MUST_CHECK;
void thr_subgroup_classes_destroy(thr_subgroup_classes *classes);

#endif
