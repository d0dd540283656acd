/* The built viewer as bytes: const char thr_viewer_page[], NUL-terminated. Found from the top of the tree, where make runs. */
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define NAME JOIN(__USER_LABEL_PREFIX__, thr_viewer_page)

#ifdef __APPLE__
        .const
#else
        .section .rodata
#endif
        .globl NAME
NAME:
        .incbin "diagram/export/viewer_page.html"
        .byte 0
#if defined(__linux__) && defined(__ELF__)
        .section .note.GNU-stack,"",%progbits
#endif
