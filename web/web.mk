# BUILD=web: the program for wasm, by Emscripten, as $(OUT)/web/thread-engine.js and .wasm. `make web` begins it
# when targets/libraries.sh has put the libraries into LIBRARIES. Of the interfaces that a browser cannot keep as they are, web/ and targets/ have the other implementation:
#   graph/process/child.c, workers.h   cli/guard.c   diagram/export/pages.c, letters.h   eval/structure/beads.h   the viewer's page   <math.h>
CC := emcc
CXX := em++
AR := emar
# Debian's modules, which a node from elsewhere does not find by itself
export NODE_PATH := /usr/share/nodejs

WEB_REPLACED := graph/process/child.c graph/process/workers.c graph/process/process.c \
	diagram/export/pages.c $(patsubst %,diagram/export/%.c,paper pdf font font_outline font_find letters svg_page) diagram/export/viewer_page.S eval/structure/spqr.c
SOURCES := $(filter-out $(WEB_REPLACED),$(SOURCES)) $(wildcard web/*.c targets/*.c)
OBJECTS = $(addsuffix .o,$(basename $(SOURCES:%=$(DIR)/%))) $(DIR)/web/viewer_page.o
CLI_OBJECTS := $(filter-out $(DIR)/cli/guard_process.o,$(CLI_OBJECTS))

WEB_LIBRARIES := $(patsubst %,$(LIBRARIES)/wasm/lib/%.a,glpk igraph nauty bullet)
PKG_CFLAGS = -isystem $(LIBRARIES)/wasm/include -isystem $(LIBRARIES)/wasm/include/nauty -isystem $(LIBRARIES)/wasm/include/zlib -isystem /usr/include/igraph -DTHR_LINKED
# clang warns of these, gcc, which the sources are kept clean for, does not
THR_CFLAGS += -Wno-sign-conversion -Wno-implicit-int-float-conversion -Wno-missing-field-initializers
BULLET_CFLAGS = -isystem /usr/include/bullet -DBT_USE_DOUBLE_PRECISION
LAZY_NAMES = -DTHR_LIBRARY_IGRAPH='"igraph"' -DTHR_LIBRARY_Z='"zlib"'
# the linker's --wrap: web/host.c, targets/libm.c
WEB_LINK := -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sTOTAL_STACK=8MB -sSUPPORT_LONGJMP=1 -sMODULARIZE=1 \
	-sEXPORT_NAME=ThreadEngine -sENVIRONMENT=web,worker,node -sINVOKE_RUN=0 -sEXIT_RUNTIME=1 \
	-sEXPORTED_RUNTIME_METHODS=callMain,FS -sNODEJS_CATCH_EXIT=0 -sNODEJS_CATCH_REJECTION=0 -lnodefs.js \
	-Wl,--wrap=sbrk,--wrap=clock_gettime,--wrap=getrusage,--wrap=sin,--wrap=cos,--wrap=tan,--wrap=asin,--wrap=acos,--wrap=atan2,--wrap=hypot
WEB_PROGRAM := $(DIR)/thread-engine.js

$(WEB_PROGRAM): $(CLI_OBJECTS) $(LIBRARY) $(WEB_LIBRARIES) web/web.mk
	@echo "  LINK  $@"
	$(Q)em++ $(MODE_web) $(WEB_LINK) -o $@ $(CLI_OBJECTS) $(LIBRARY) $(WEB_LIBRARIES)

# the bytes of the viewer's page as C, which Emscripten's assembler does not take as they are
$(DIR)/web/viewer_page.c: diagram/export/viewer_page.html
	@mkdir -p $(@D)
	@{ echo 'extern const char thr_viewer_page[];'; echo 'const char thr_viewer_page[] = {'; \
	   od -An -v -tu1 $< | sed 's/[0-9][0-9]*/(char)&,/g'; echo '0};'; } > $@
$(DIR)/web/viewer_page.o: $(DIR)/web/viewer_page.c
	@echo "  CC    $@"
	$(Q)emcc -O1 -c -o $@ $<

# what is handed on: the engine, the page with all in it, and the npm package around it
NPM := $(DIR)/npm
web-files: $(WEB_PROGRAM) $(DIR)/engine.js $(DIR)/thread.html $(DIR)/thread-3dm.js $(NPM)/package.json
$(DIR)/thread-3dm.js: $(wildcard web/rhino/*)
	@echo "  PAGE  $@"
	$(Q)web/rhino/build.sh $(LIBRARIES)/rhino3dm $@
$(DIR)/thread.html: $(wildcard web/page/*) $(WEB_PROGRAM) $(DIR)/engine.js Makefile
	@echo "  PAGE  $@"
	$(Q)web/page/build.sh $(DIR) $(VERSION)
$(DIR)/engine.js: web/engine.js
	@cp $< $@
$(NPM)/package.json: $(WEB_PROGRAM) $(DIR)/engine.js $(wildcard web/npm/*) Makefile
	@mkdir -p $(NPM)
	@cp $(DIR)/thread-engine.js $(DIR)/thread-engine.wasm $(DIR)/engine.js web/npm/README.md web/npm/engine.d.ts web/npm/thread.js web/npm/worker.js LICENSE $(NPM)
	@sed 's/@VERSION@/$(VERSION)/' web/npm/package.json > $@.new
	@mv $@.new $@
