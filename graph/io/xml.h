/* Internal to the readers of XML formats: the tags of a document one after the other, with the text before each. Comments,
 * instructions and the document type are passed over; entities are the five of XML and numbers. */
#ifndef THR_XML_H
#define THR_XML_H

#include "graph/io/scan.h"

typedef enum { THR_XML_END, THR_XML_OPEN, THR_XML_CLOSE, THR_XML_EMPTY } thr_xml_kind;

typedef struct {
  thr_scan scan; /* line: of the tag */
  thr_xml_kind kind;
  thr_span name;       /* of the tag, without what stands before a colon */
  thr_span attributes; /* as they are written */
  thr_span text;       /* before the tag and after the last one, as it is written */
} thr_xml;

thr_status thr_xml_start(thr_xml *xml, const char *text, size_t n, const char *name, thr_err *err) THR_MUST_CHECK;
thr_status thr_xml_next(thr_xml *xml, thr_err *err) THR_MUST_CHECK;

/* The value of an attribute of the tag into out, instead of what it held; false if there is none. */
bool thr_xml_attribute(const thr_xml *xml, const char *name, thr_text *out);

/* Appends text with its entities and CDATA resolved and without its comments. */
void thr_xml_plain(thr_span text, thr_text *out);

#endif
