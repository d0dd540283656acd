/* Libraries that few commands need are loaded when one of their functions is first called: what starts `thread check` is small.
 * The headers are used as ever; only calls go through pointers. */
#ifndef THR_LAZY_H
#define THR_LAZY_H

#include "graph/status.h"

typedef struct {
  const char *name;
  void *pointer;        /* address of a pointer to a function, which receives that of this name */
  void (*linked)(void); /* the function, where the library is linked with the program (THR_LINKED); else NULL */
} thr_lazy_symbol;

/* For a list of functions  #define FUNCTIONS(F) F(one) F(two):
 * struct { FUNCTIONS(THR_LAZY_POINTER) bool loaded; } lib, and the symbols {FUNCTIONS(THR_LAZY_SYMBOL)} that fill it. */
#define THR_LAZY_POINTER(f) __typeof__(f) *(f);
#ifdef THR_LINKED
#define THR_LAZY_SYMBOL(f) {#f, &lib.f, (void (*)(void))(f)},
#else
#define THR_LAZY_SYMBOL(f) {#f, &lib.f, NULL},
#endif

/* Unless *loaded, loads a library by the name that the run-time linker knows it by (libz.so.1) and fills the pointers, from
 * it and from the libraries that it needs itself. What is loaded stays. THR_ESOLVER with the linker's reason and what to do. A
 * few ms. */
thr_status thr_lazy_load(bool *loaded, const char *library, const thr_lazy_symbol *symbol, size_t n, thr_err *err) THR_MUST_CHECK;

#endif
