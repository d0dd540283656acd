/* Writing DXF: drawings in the sense of release 12 (AC1009), the oldest that everything reads, with a unit. Autodesk, "DXF
 * Reference". */
#ifndef THR_DXF_H
#define THR_DXF_H

#include "graph/text.h"

/* The unit of each code of $INSUNITS, NULL for 0 and where there is no such code. */
enum { THR_DXF_UNITS = 25 };
const char *thr_dxf_unit(int code);

typedef struct {
  char name[32];
  int colour; /* of AutoCAD's index */
} thr_dxf_layer;

void thr_dxf_pair(thr_text *out, int code, const char *value);
void thr_dxf_int(thr_text *out, int code, int value);
/* Codes 10 + first, 20 + first and 30 + first. */
void thr_dxf_point(thr_text *out, int first, const double xyz[3]);

/* All before the first entity: units, layers, and the begin of the entities; and what ends the file. */
void thr_dxf_begin(thr_text *out, const char *units, const thr_dxf_layer *layer, int n_layers);
void thr_dxf_end(thr_text *out);

#endif
