/* The only file that knows igraph. igraph's default error handler aborts the program; ours returns the error code.
 * No routine of igraph that uses GLPK may be called here: it would replace the hooks that lp/lp_glpk.c sets. */
#include "graph/automorphism_count.h"
#include "graph/cuttree.h"
#include "graph/drawing.h"

#include <igraph.h>

static thr_status failed(igraph_error_t code, thr_err *err)
{
  if (code == IGRAPH_ENOMEM) return thr_nomem(err);
  return thr_fail(err, THR_ESOLVER, "igraph: %s", igraph_strerror(code));
}

/* Initializes ends with those of the m edges, one after the other. */
static igraph_error_t list_ends(igraph_vector_int_t *ends, int m, const int (*edge)[2])
{
  igraph_error_t code = igraph_vector_int_init(ends, 2 * (igraph_integer_t)m);
  if (code) return code;
  for (int e = 0; e < m; e++) {
    VECTOR(*ends)[2 * e] = edge[e][0];
    VECTOR(*ends)[2 * e + 1] = edge[e][1];
  }
  return code;
}

static igraph_error_t cut_tree(const igraph_vector_int_t *ends, int n, const igraph_vector_t *capacity, int (*tree)[2],
                               double *flow)
{
  igraph_t g, t;
  igraph_vector_t flows;
  igraph_error_t code = igraph_create(&g, ends, n, IGRAPH_UNDIRECTED);
  if (code) return code;
  if ((code = igraph_vector_init(&flows, 0))) goto no_flows;
  if ((code = igraph_gomory_hu_tree(&g, &t, &flows, capacity))) goto no_tree;
  for (int i = 0; i < n - 1; i++) {
    tree[i][0] = (int)IGRAPH_FROM(&t, i);
    tree[i][1] = (int)IGRAPH_TO(&t, i);
    flow[i] = VECTOR(flows)[i];
  }
  igraph_destroy(&t);
no_tree:
  igraph_vector_destroy(&flows);
no_flows:
  igraph_destroy(&g);
  return code;
}

thr_status thr_cut_tree(int n, int m, const int (*edge)[2], const double *capacity, int (*tree)[2], double *flow, thr_err *err)
{
  igraph_error_handler_t *old = igraph_set_error_handler(igraph_error_handler_ignore);
  igraph_vector_int_t ends;
  igraph_vector_t weights;
  igraph_error_t code = list_ends(&ends, m, edge);
  if (code) goto no_ends;
  if ((code = igraph_vector_init(&weights, m))) goto no_weights;
  for (int e = 0; e < m; e++)
    VECTOR(weights)[e] = capacity[e];
  code = cut_tree(&ends, n, &weights, tree, flow);
  igraph_vector_destroy(&weights);
no_weights:
  igraph_vector_int_destroy(&ends);
no_ends:
  igraph_set_error_handler(old);
  return code ? failed(code, err) : THR_OK;
}

static igraph_error_t count_coloured(const igraph_t *g, const int *colour, igraph_bliss_info_t *info)
{
  igraph_vector_int_t colours;
  if (!colour) return igraph_automorphisms(g, NULL, IGRAPH_BLISS_FL, info);
  igraph_error_t code = igraph_vector_int_init(&colours, igraph_vcount(g));
  if (code) return code;
  for (igraph_integer_t v = 0; v < igraph_vcount(g); v++)
    VECTOR(colours)[v] = colour[v];
  code = igraph_automorphisms(g, &colours, IGRAPH_BLISS_FL, info);
  igraph_vector_int_destroy(&colours);
  return code;
}

thr_status thr_automorphism_count(int n, int m, const int (*edge)[2], const int *colour, char **digits, thr_err *err)
{
  igraph_error_handler_t *old = igraph_set_error_handler(igraph_error_handler_ignore);
  igraph_vector_int_t ends;
  igraph_t g;
  igraph_bliss_info_t info = {0};
  igraph_error_t code = list_ends(&ends, m, edge);
  if (code) goto no_ends;
  if ((code = igraph_create(&g, &ends, n, IGRAPH_UNDIRECTED))) goto no_graph;
  code = count_coloured(&g, colour, &info);
  igraph_destroy(&g);
no_graph:
  igraph_vector_int_destroy(&ends);
no_ends:
  igraph_set_error_handler(old);
  *digits = code ? NULL : thr_strdup(info.group_size);
  igraph_free(info.group_size);
  if (code) return failed(code, err);
  return *digits ? THR_OK : thr_nomem(err);
}

static igraph_error_t kamada_kawai(const igraph_t *g, const igraph_vector_t *length, bool circle, double (*xy)[2])
{
  igraph_matrix_t at;
  igraph_integer_t n = igraph_vcount(g);
  igraph_error_t code = igraph_matrix_init(&at, n, 2);
  if (code) return code;
  for (igraph_integer_t v = 0; v < n; v++)
    for (int k = 0; k < 2; k++)
      MATRIX(at, v, k) = xy[v][k];
  code = igraph_layout_kamada_kawai(g, &at, !circle, 50 * n, 0, (double)n, length, NULL, NULL, NULL, NULL);
  for (igraph_integer_t v = 0; v < n && !code; v++)
    for (int k = 0; k < 2; k++)
      xy[v][k] = MATRIX(at, v, k);
  igraph_matrix_destroy(&at);
  return code;
}

thr_status thr_kamada_kawai(int n, int m, const int (*edge)[2], const double *length, bool circle, double (*xy)[2], thr_err *err)
{
  igraph_error_handler_t *old = igraph_set_error_handler(igraph_error_handler_ignore);
  igraph_vector_int_t ends;
  igraph_vector_t lengths;
  igraph_t g;
  igraph_error_t code = list_ends(&ends, m, edge);
  if (code) goto no_ends;
  if ((code = igraph_create(&g, &ends, n, IGRAPH_UNDIRECTED))) goto no_graph;
  if ((code = igraph_vector_init(&lengths, m))) goto no_lengths;
  for (int e = 0; e < m; e++)
    VECTOR(lengths)[e] = length[e];
  code = kamada_kawai(&g, &lengths, circle, xy);
  igraph_vector_destroy(&lengths);
no_lengths:
  igraph_destroy(&g);
no_graph:
  igraph_vector_int_destroy(&ends);
no_ends:
  igraph_set_error_handler(old);
  return code ? failed(code, err) : THR_OK;
}

const char *thr_igraph_version(void)
{
  const char *text;
  igraph_version(&text, NULL, NULL, NULL);
  return text;
}
