/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a mesh as binary STL (3D Systems, 1989): a heading of 80 bytes, the number of triangles,
 * then 50 bytes for each: normal and corners as numbers of 32 bits, little-endian, and two zeros.
 */
#include "kit/files.h"

#include "graph/number.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

double thr_kit_normal(const thr_mesh *mesh, int triangle, double normal[3])
{
  const int *corner = mesh->triangle[triangle];
  double e[3], f[3];
  for (int k = 0; k < 3; k++) {
    e[k] = mesh->point[corner[1]][k] - mesh->point[corner[0]][k];
    f[k] = mesh->point[corner[2]][k] - mesh->point[corner[0]][k];
  }
  thr_cross(e, f, normal);
  return 0.5 * thr_normalize(normal);
}

/* Writes a whole number of four bytes, the lowest byte first. */
static void put_32(char *to, uint32_t value)
{
  for (int i = 0; i < 4; i++)
    to[i] = (char)(value >> 8 * i & 0xff);
}

/* Writes a vector as three numbers of 32 bits. */
static void put_vector(char *to, const double v[3])
{
  for (int k = 0; k < 3; k++) {
    float number = (float)v[k];
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    put_32(to + 4 * k, bits);
  }
}

/* Turns a vector of a mesh as it stands on the bed. */
static void turn(const thr_kit_stand *stand, const double v[3], double turned[3])
{
  for (int k = 0; k < 3; k++)
    turned[k] = thr_dot(&stand->turn[3 * k], v);
}

void thr_kit_stl(const thr_kit_plates *plates, int piece, thr_text *out)
{
  const thr_kit *kit = plates->kit;
  const thr_mesh *mesh = &kit->mesh[kit->piece[piece].like];
  const thr_kit_stand *stand = &plates->stand[kit->piece[piece].like];

  /* A heading that begins with "solid" would be taken for text. */
  char heading[84] = "binary STL, lengths in mm: ";
  size_t begun = strlen(heading);
  snprintf(heading + begun, 80 - begun, "%s", kit->kind_name[kit->piece[piece].kind]);
  put_32(heading + 80, (uint32_t)mesh->n_triangles);
  thr_text_append_bytes(out, heading, sizeof heading);

  for (int t = 0; t < mesh->n_triangles; t++) {
    char bytes[50] = {0};
    double normal[3], turned[3];
    thr_kit_normal(mesh, t, normal);
    turn(stand, normal, turned);
    put_vector(bytes, turned);
    for (int k = 0; k < 3; k++) {
      turn(stand, mesh->point[mesh->triangle[t][k]], turned);
      for (int l = 0; l < 3; l++)
        turned[l] -= stand->low[l];
      put_vector(bytes + 12 * (k + 1), turned);
    }
    thr_text_append_bytes(out, bytes, sizeof bytes);
  }
}

void thr_kit_stl_name(const thr_kit *kit, int piece, char name[64])
{
  snprintf(name, 64, "%s-print-%dx.stl", kit->kind_name[kit->piece[piece].kind],
           kit->piece[kit->piece[piece].like].count);
  for (char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c) && !strchr("-._", *c)) *c = '_';
}
