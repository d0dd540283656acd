# BUILD=static: the program with everything that it needs in it, as $(OUT)/static/thread. `make static` begins it when
# targets/libraries.sh has put the libraries into LIBRARIES; Debian's own archives are there for fontconfig and zlib. The interface
# that is implemented a second time here:
#   eval/structure/beads.h (SuiteSparse wants BLAS and Fortran's runtime)
SOURCES := $(filter-out eval/structure/spqr.c,$(SOURCES)) targets/householder.c
OBJECTS = $(addsuffix .o,$(basename $(SOURCES:%=$(DIR)/%)))

PKG_CFLAGS = -isystem $(LIBRARIES)/linux/include -isystem $(LIBRARIES)/linux/include/nauty -isystem /usr/include/igraph -DTHR_LINKED
BULLET_CFLAGS = -isystem /usr/include/bullet -DBT_USE_DOUBLE_PRECISION
LAZY_NAMES = $(foreach name,IGRAPH FONTCONFIG Z,-DTHR_LIBRARY_$(name)='"$(name)"')
STATIC_LIBRARIES := $(patsubst %,$(LIBRARIES)/linux/lib/%.a,igraph nauty glpk bullet)
$(DIR)/thread: $(STATIC_LIBRARIES)
THR_LIBS = -lgmp $(shell pkg-config --static --libs fontconfig zlib) -lm $(LDLIBS)
LINK += -static -Wl,--gc-sections
