/* SPDX-License-Identifier: GPL-3.0-or-later */
/* THR_WIDE before a function: compiled for wider registers, too, and chosen when the program
 * starts. Nothing is contracted and no sum reordered (-ffp-contract=off): the digits are those of
 * the narrow one. */
#ifndef THR_WIDE_H
#define THR_WIDE_H

#if defined __x86_64__ && defined __gnu_linux__ && defined __GNUC__ && !defined __clang__ &&       \
    !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define THR_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define THR_WIDE
#endif
#define THR_INLINE static inline __attribute__((always_inline))

#endif
