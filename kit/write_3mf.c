/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a kit as a 3MF package (3MF Consortium, "3D Manufacturing Format, core specification",
 * namespace of 2015/02): a ZIP file (PKWARE, APPNOTE.TXT 6.3) with three members: the kinds of
 * files inside, where the model is, and the model in XML.
 *
 * An object is a mesh, and an item of the build is a piece that stands where it is printed. Dates
 * are that of the beginning of ZIP, so that the same kit gives the same bytes. Where zlib is
 * missing members are stored as they are.
 *
 * Example: <item objectid="3" transform="1 0 0 0 1 0 0 0 1 25.4 31 12" partnumber="B5"/> */
#include "kit/files.h"

#include "diagram/export/export_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm between plates. */
static const double BETWEEN = 30;

/* ---- ZIP ---- */

/* A package that grows member by member, and its last member, which grows piece by piece. */
typedef struct {
  thr_text *out, directory, piece; /* piece: what is not yet compressed */
  size_t begin, at, length; /* in out: the package, the member; bytes of the member that are */
  uint32_t checksum;        /* of these */
  thr_deflater *deflater;   /* NULL between members */
  int n_members;
} package;

uint32_t thr_kit_checksum(uint32_t sum, const char *bytes, size_t n)
{
  uint32_t table[256], crc = ~sum;
  for (uint32_t i = 0; i < 256; i++) {
    table[i] = i;
    for (int bit = 0; bit < 8; bit++)
      table[i] = table[i] >> 1 ^ (table[i] & 1 ? UINT32_C(0xedb88320) : 0);
  }
  for (size_t i = 0; i < n; i++)
    crc = crc >> 8 ^ table[(crc ^ (unsigned char)bytes[i]) & 0xff];
  return ~crc;
}

void thr_kit_number(thr_text *out, uint64_t value, int bytes)
{
  for (int i = 0; i < bytes; i++, value >>= 8)
    thr_text_byte(out, (char)(value & 0xff));
}

/* Begins a member, whose bytes are put into the piece. Its checksum and sizes are left 0. */
static thr_status begin_member(package *zip, const char *name, thr_err *err)
{
  thr_text *out = zip->out;
  zip->at = out->length;
  zip->length = zip->checksum = 0;

  /* Version, flags, method, time and date, checksum, sizes, lengths of names. */
  thr_text_append_bytes(out, "PK\3\4", 4);
  thr_kit_number(out, 20, 2);
  thr_kit_number(out, 0, 2);
  thr_kit_number(out, 8, 2);
  thr_kit_number(out, 0, 2);
  thr_kit_number(out, 1 << 5 | 1, 2); /* the first of January of 1980 */
  thr_kit_number(out, 0, 12);
  thr_kit_number(out, strlen(name), 2);
  thr_kit_number(out, 0, 2);
  thr_text_append(out, name);
  return thr_deflater_make(&zip->deflater, THR_DEFLATE_FAST, true, err);
}

/* Compresses the piece, and empties it. */
static thr_status put_piece(package *zip, bool last, thr_err *err)
{
  thr_text *piece = &zip->piece;
  if (piece->failed) return thr_nomem(err);
  zip->checksum = thr_kit_checksum(zip->checksum, piece->data, piece->length);
  zip->length += piece->length;
  thr_status st = thr_deflater_put(zip->deflater, piece->data, piece->length, last, zip->out, err);
  piece->length = 0;
  if (!st && zip->length + zip->out->length > UINT32_MAX / 2)
    st = thr_fail(err, THR_EINPUT, "kit.3mf would have more than 2 GB: write STL instead");
  return st;
}

/* Ends the member: its checksum and sizes, and its entry in the directory. */
static thr_status end_member(package *zip, const char *name, thr_err *err)
{
  enum { HEAD = 30, SAME = 26, NUMBERS = 14 }; /* bytes: all, those of both entries; to the sums */
  thr_status st = put_piece(zip, true, err);
  thr_deflater_destroy(zip->deflater);
  zip->deflater = NULL;
  if (st) return st;

  char *head = zip->out->data + zip->at;
  const uint64_t known[] = {zip->checksum, zip->out->length - zip->at - HEAD - strlen(name),
                            zip->length};
  for (int i = 0; i < 12; i++)
    head[NUMBERS + i] = (char)(known[i / 4] >> 8 * (i % 4) & 0xff);

  /* In the directory also: no comment, first disk, no attributes, where the member is. */
  thr_text *directory = &zip->directory;
  thr_text_append_bytes(directory, "PK\1\2", 4);
  thr_kit_number(directory, 20, 2);
  thr_text_append_bytes(directory, head + HEAD - SAME, SAME);
  thr_kit_number(directory, 0, 10);
  thr_kit_number(directory, zip->at - zip->begin, 4);
  thr_text_append(directory, name);
  zip->n_members++;
  return THR_OK;
}

/* Adds a member that is short. */
static thr_status add_member(package *zip, const char *name, const char *text, thr_err *err)
{
  thr_status st = begin_member(zip, name, err);
  thr_text_append(&zip->piece, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  thr_text_append(&zip->piece, text);
  return st ? st : end_member(zip, name, err);
}

/* Ends the file with the directory. */
static void end_package(package *zip)
{
  size_t at = zip->out->length - zip->begin, length = zip->directory.length;
  thr_text_append_bytes(zip->out, zip->directory.data, length);
  thr_text_append_bytes(zip->out, "PK\5\6", 4);
  thr_kit_number(zip->out, 0, 4);
  thr_kit_number(zip->out, (uint64_t)zip->n_members, 2);
  thr_kit_number(zip->out, (uint64_t)zip->n_members, 2);
  thr_kit_number(zip->out, length, 4);
  thr_kit_number(zip->out, at, 4);
  thr_kit_number(zip->out, 0, 2);
}

/* ---- the model ---- */

static double rounded(double value, double unit)
{
  return nearbyint(value / unit) * unit;
}

/* Returns whether rounding leaves all points of a mesh apart. Points are sorted by a sum that
 * hardly two of them share. */
static bool stay_apart(const thr_mesh *mesh, double unit, thr_ranked *order)
{
  static const double weight[3] = {1, 1.6180339887, 2.7182818285};
  double(*point)[3] = mesh->point;
  for (int i = 0; i < mesh->n_points; i++) {
    order[i] = (thr_ranked){.index = i};
    for (int k = 0; k < 3; k++)
      order[i].key += weight[k] * rounded(point[i][k], unit);
  }
  thr_sort_ranked(order, (size_t)mesh->n_points);

  for (int i = 0; i < mesh->n_points; i++)
    for (int j = i + 1; j < mesh->n_points && order[j].key == order[i].key; j++) {
      bool same = true;
      for (int k = 0; k < 3; k++)
        same &= rounded(point[order[i].index][k], unit) == rounded(point[order[j].index][k], unit);
      if (same) return false;
    }
  return true;
}

/* Appends a number as XML allows it, rounded to a unit, 1e-6 .. */
static void put_rounded(thr_text *xml, double value, double unit)
{
  thr_text_double(xml, nearbyint(value / unit) / nearbyint(1 / unit));
}

/* Appends a mesh. Points are rounded to a millionth of a mm, or finer if two would become one. */
static thr_status put_mesh(const thr_mesh *mesh, thr_text *xml, thr_err *err)
{
  thr_ranked *order = thr_calloc((size_t)mesh->n_points, sizeof *order);
  if (!order) return thr_nomem(err);
  double unit = 1e-6;
  while (unit > 1e-12 && !stay_apart(mesh, unit, order))
    unit /= 10;
  free(order);

  static const char axis[] = "xyz";
  thr_text_append(xml, "   <mesh>\n    <vertices>\n");
  for (int i = 0; i < mesh->n_points; i++) {
    thr_text_append(xml, "<vertex");
    for (int k = 0; k < 3; k++) {
      thr_text_byte(xml, ' ');
      thr_text_byte(xml, axis[k]);
      thr_text_append(xml, "=\"");
      put_rounded(xml, mesh->point[i][k], unit);
      thr_text_byte(xml, '"');
    }
    thr_text_append(xml, "/>\n");
  }

  thr_text_append(xml, "    </vertices>\n    <triangles>\n");
  for (int t = 0; t < mesh->n_triangles; t++) {
    thr_text_append(xml, "<triangle");
    for (int k = 0; k < 3; k++) {
      thr_text_append(xml, " v");
      thr_text_byte(xml, (char)('1' + k));
      thr_text_append(xml, "=\"");
      thr_text_int(xml, mesh->triangle[t][k]);
      thr_text_byte(xml, '"');
    }
    thr_text_append(xml, "/>\n");
  }
  thr_text_append(xml, "    </triangles>\n   </mesh>\n");
  return THR_OK;
}

/* Returns whether a piece is on the plate that is written; -1: all are. */
static bool is_on(const thr_kit_plates *plates, int p, int plate)
{
  return plate < 0 || plates->plate[p] == plate;
}

/* Writes the objects: a mesh each that is on the plate, called as its kind; one that no other
 * piece shares, as its kind and piece. The number of an object is that of its kind. used: scratch,
 * [n_pieces] all false. */
static thr_status put_objects(const thr_kit_plates *plates, int plate, bool *used, package *zip,
                              thr_err *err)
{
  const thr_kit *kit = plates->kit;
  thr_text *xml = &zip->piece;
  thr_status st = THR_OK;
  for (int p = 0; p < kit->n_pieces; p++)
    used[kit->piece[p].like] |= is_on(plates, p, plate);

  for (int p = 0; p < kit->n_pieces && !st; p++) {
    const thr_kit_piece *piece = &kit->piece[p];
    if (!used[p]) continue;
    const char *kind = kit->kind_name[piece->kind];
    thr_text_printf(xml, "  <object id=\"%d\" type=\"model\" partnumber=\"", piece->kind);
    thr_text_xml(xml, kind);
    thr_text_append(xml, "\" name=\"");
    thr_text_xml(xml, kind);
    if (piece->count == 1) {
      thr_text_byte(xml, '/');
      thr_text_xml(xml, kit->name[p]);
    }
    thr_text_append(xml, "\">\n");
    st = put_mesh(&kit->mesh[p], xml, err);
    thr_text_append(xml, "  </object>\n");
    if (!st) st = put_piece(zip, false, err);
  }
  return st;
}

/* Appends the items: every piece, turned as it stands and moved to its place. A point is a row that
 * is multiplied by the matrix, so its rows are the images of the axes. */
static void put_items(const thr_kit_plates *plates, int plate, thr_text *xml)
{
  const thr_kit *kit = plates->kit;
  for (int p = 0; p < kit->n_pieces; p++) {
    if (!is_on(plates, p, plate)) continue;
    const thr_kit_stand *stand = &plates->stand[kit->piece[p].like];
    thr_text_printf(xml, "  <item objectid=\"%d\" transform=\"", kit->piece[p].kind);
    for (int i = 0; i < 9; i++) {
      put_rounded(xml, stand->turn[3 * (i % 3) + i / 3], 1e-12);
      thr_text_byte(xml, ' ');
    }
    double next = plate < 0 ? plates->plate[p] * (kit->options.bed[0] + BETWEEN) : 0;
    put_rounded(xml, next + plates->at[p][0] - stand->low[0], 1e-6);
    thr_text_byte(xml, ' ');
    put_rounded(xml, plates->at[p][1] - stand->low[1], 1e-6);
    thr_text_byte(xml, ' ');
    put_rounded(xml, -stand->low[2], 1e-6);
    thr_text_append(xml, "\" partnumber=\"");
    thr_text_xml(xml, kit->name[p]);
    thr_text_append(xml, "\"/>\n");
  }
}

/* Writes the model, object by object: its XML is four times as long as the file. */
static thr_status put_model(const thr_kit_plates *plates, int plate, package *zip, thr_err *err)
{
  thr_text *xml = &zip->piece;
  bool *used = thr_calloc((size_t)plates->kit->n_pieces, sizeof *used);
  thr_status st = used ? begin_member(zip, "3D/3dmodel.model", err) : thr_nomem(err);
  thr_text_append(xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<model unit=\"millimeter\" xml:lang=\"en-US\" "
                       "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
                       " <metadata name=\"Application\">thread</metadata>\n <resources>\n");
  if (!st) st = put_objects(plates, plate, used, zip, err);
  free(used);
  thr_text_append(xml, " </resources>\n <build>\n");
  put_items(plates, plate, xml);
  thr_text_append(xml, " </build>\n</model>\n");
  return st ? st : end_member(zip, "3D/3dmodel.model", err);
}

thr_status thr_kit_3mf(const thr_kit_plates *plates, int plate, thr_text *out, thr_err *err)
{
  package zip = {.out = out, .begin = out->length};
  thr_status st = thr_deflate_load(err);
  if (!st)
    st = add_member(
        &zip, "[Content_Types].xml",
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
        " <Default Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
        " <Default Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n"
        "</Types>\n",
        err);
  if (!st)
    st = add_member(
        &zip, "_rels/.rels",
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
        " <Relationship Id=\"model\" Target=\"/3D/3dmodel.model\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
        "</Relationships>\n",
        err);
  if (!st) st = put_model(plates, plate, &zip, err);
  if (!st) end_package(&zip);
  if (!st && (out->failed || zip.directory.failed)) st = thr_nomem(err);

  /* After a failure nothing has been appended. */
  if (st && out->data) out->data[out->length = zip.begin] = '\0';
  thr_deflater_destroy(zip.deflater);
  thr_text_destroy(&zip.piece);
  thr_text_destroy(&zip.directory);
  return st;
}
