# BUILD=windows: the program for Windows, by MinGW, as $(OUT)/windows/thread.exe, which needs nothing but Windows 10 or later (64 bits).
# `make windows` begins it when targets/libraries.sh has put the libraries into LIBRARIES. The interfaces that are implemented a
# second time, in targets/ and targets/windows/:
#   graph/os.h   graph/process/child.c, workers.h   cli/guard.c   diagram/export/pages.c, letters.h   eval/structure/beads.h   <math.h>
CC := x86_64-w64-mingw32-gcc-posix
CXX := x86_64-w64-mingw32-g++-posix
AR := x86_64-w64-mingw32-ar
WINDRES := x86_64-w64-mingw32-windres

WINDOWS_REPLACED := graph/os.c $(patsubst %,graph/process/%.c,child workers process) \
	$(patsubst %,diagram/export/%.c,pages paper pdf font font_outline font_find letters svg_page) eval/structure/spqr.c
SOURCES := $(filter-out $(WINDOWS_REPLACED),$(SOURCES)) $(wildcard targets/*.c targets/windows/*.c)
OBJECTS = $(addsuffix .o,$(basename $(SOURCES:%=$(DIR)/%)))
CLI_OBJECTS := $(filter-out $(DIR)/cli/guard_process.o,$(CLI_OBJECTS)) $(DIR)/targets/windows/manifest.o
PROGRAM := $(DIR)/thread.exe

PKG_CFLAGS = -isystem $(LIBRARIES)/windows/include -isystem $(LIBRARIES)/windows/include/nauty -isystem $(LIBRARIES)/windows/include/zlib -isystem /usr/include/igraph \
	-DTHR_LINKED -DAVOID_SYS_WAIT_H -D__USE_MINGW_ANSI_STDIO=1
# its headers' own macros and what it takes %zu for
THR_CFLAGS += -Wno-float-conversion -Wno-format -Wno-format-extra-args
BULLET_CFLAGS = -isystem /usr/include/bullet -DBT_USE_DOUBLE_PRECISION
LAZY_NAMES = -DTHR_LIBRARY_IGRAPH='"igraph"' -DTHR_LIBRARY_Z='"zlib"'
WINDOWS_LIBRARIES := $(patsubst %,$(LIBRARIES)/windows/lib/%.a,igraph nauty glpk bullet)
$(PROGRAM): $(WINDOWS_LIBRARIES)
THR_LIBS = -lm $(LDLIBS)
# --wrap: targets/libm.c; without the time of linking the bytes are the same
LINK += -static -s -Wl,--gc-sections,--no-insert-timestamp,--wrap=sin,--wrap=cos,--wrap=tan,--wrap=asin,--wrap=acos,--wrap=atan2,--wrap=hypot

$(DIR)/targets/windows/manifest.o: targets/windows/thread.manifest
	@mkdir -p $(@D)
	@echo "  RES   $@"
	$(Q)echo '1 24 "$<"' | $(WINDRES) -o $@
