/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a program of one process asks of what runs it: of the page, worker or node (web/host.c), of
 * Windows (targets/windows/os.c). */
#ifndef THR_HOST_H
#define THR_HOST_H

#include <stddef.h>

/* No more memory than so many bytes from now on, 0 = as much as there is: malloc gives none then.
 */
void host_bound_memory(double bytes);

/* The best plan so far, n bytes of JSON, which nobody may have to write. */
void host_plan(const char *json, size_t n);

#endif
