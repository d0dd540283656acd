# BUILD=wheel: libthread as one shared library that needs nothing but the C library, for the Python wheel. `make wheel` begins it when
# targets/libraries.sh has put the libraries, compiled for that, into LIBRARIES. What is linked and what is implemented a second time
# is as in static.mk, but fontconfig and zlib, which the system has or has not, are still loaded when needed.
SOURCES := $(filter-out eval/structure/spqr.c,$(SOURCES)) targets/householder.c
OBJECTS = $(addsuffix .o,$(basename $(SOURCES:%=$(DIR)/%)))

PKG_CFLAGS = -isystem $(LIBRARIES)/shared/include -isystem $(LIBRARIES)/shared/include/nauty -isystem /usr/include/igraph
BULLET_CFLAGS = -isystem /usr/include/bullet -DBT_USE_DOUBLE_PRECISION
LAZY_NAMES = -DTHR_LIBRARY_IGRAPH='"igraph"' $(shell tools/library-names.sh $(call quote,$(COMPILER)) fontconfig z -- $(shell pkg-config --libs fontconfig zlib))
$(DIR)/graph/framework/igraph.o: CPPFLAGS += -DTHR_LINKED
SHARED_LIBRARIES := $(patsubst %,$(LIBRARIES)/shared/lib/%.a,igraph nauty glpk bullet)
$(DIR)/$(notdir $(SHARED)): $(SHARED_LIBRARIES)
THR_LIBS = $(SHARED_LIBRARIES) -lm $(LDLIBS)
LINK += -static-libstdc++ -static-libgcc -Wl,--gc-sections
