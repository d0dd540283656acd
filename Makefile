# thread: build, test and install. `make help` lists the targets.
VERSION := 0.1.0
# of this version, for the man pages
DATE := 2026-11-23

# Choices, as `make BUILD=asan` or in the environment
BUILD ?= release
# release | debug | asan (address + undefined behaviour) | cov (gcov) | fuzz (clang) | mutants (its modules in a shared library); into $(OUT)/$(BUILD)
OUT ?= build
# everything made goes below this folder
PREFIX ?= /usr/local
DESTDIR ?=
LIBDIR ?= $(PREFIX)/lib
FUZZ_SECONDS ?= 60
# seconds per target of `make fuzz`
WERROR ?= $(filter true 1,$(CI))
# not empty and not 0: warnings are errors
V ?=
# V=1 shows the commands

# What the demo runs; DEMO_OUT holds plan.json and the drawing
DEMO_OUT = $(OUT)/demo
DEMO = plan data/dome7.json -o $(DEMO_OUT)/plan.json --draw $(DEMO_OUT)

# Debian 12 packages
BUILD_PACKAGES := build-essential pkg-config libglpk-dev libigraph-dev libnauty2-dev libbullet-dev \
	libsuitesparse-dev libfontconfig-dev zlib1g-dev fonts-dejavu-core python3
TEST_PACKAGES := check clang clang-format libclang-rt-14-dev librsvg2-bin libxml2-utils poppler-utils python3 python3-pil apngdis time cmake man-db mandoc mypy
# from elsewhere than Debian it serves as well
NPM_PACKAGES = $(if $(shell command -v npm),,nodejs npm)
VIEWER_PACKAGES = chromium $(NPM_PACKAGES)
LINT_PACKAGES := clang-format clang-tidy cppcheck
BENCH_PACKAGES := liblemon-dev libboost-graph-dev python3 time
COVERAGE_PACKAGES := check gcovr
WEB_PACKAGES := emscripten
WINDOWS_PACKAGES := gcc-mingw-w64-x86-64-posix g++-mingw-w64-x86-64-posix
# what `make web`, `make static` and `make windows` build once and keep: the libraries that they link, with their sources
LIBRARIES ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/thread-libraries

ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := g++
endif
FUZZ_CC ?= clang
FUZZ_CXX ?= clang++
CLANG_FORMAT ?= clang-format
OBJCOPY ?= objcopy

# Asked for once and only when a recipe needs it: on a bare machine `make demo` installs pkg-config and the libraries first.
PKG_CFLAGS = $(eval PKG_CFLAGS := $$(shell pkg-config --cflags igraph nauty))$(PKG_CFLAGS)
PKG_LIBS = $(eval PKG_LIBS := $$(shell pkg-config --libs nauty bullet-float64))$(PKG_LIBS)
# Loaded when needed (graph/process/lazy.c): igraph, fontconfig, zlib, SuiteSparseQR with CHOLMOD. Their names at run time, such as
# libz.so.1, are those that the linker writes into a program.
LAZY_LIBS = $(shell pkg-config --libs igraph fontconfig zlib) -lspqr
LAZY_NAMES = $(eval LAZY_NAMES := $$(shell tools/library-names.sh $$(call quote,$$(COMPILER)) igraph fontconfig z spqr -- $$(LAZY_LIBS)))$(LAZY_NAMES)
BULLET_CFLAGS = $(eval BULLET_CFLAGS := $$(patsubst -I%,-isystem %,$$(shell pkg-config --cflags bullet-float64)))$(BULLET_CFLAGS)
# no pkg-config file in Debian 12
SPQR_CFLAGS ?= -isystem /usr/include/suitesparse
CHECK_CFLAGS = $(eval CHECK_CFLAGS := $$(shell pkg-config --cflags check))$(CHECK_CFLAGS)
CHECK_LIBS = $(eval CHECK_LIBS := $$(shell pkg-config --libs check))$(CHECK_LIBS)

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Wvla
SANITIZE := -g -fno-sanitize-recover=all -fno-omit-frame-pointer
# one build of the modules serves the program and the shared library, of which only thread_* is seen
MODE_release := -O2 -fPIC -fvisibility=hidden
MODE_debug := -O0 -g
MODE_asan := -O1 -fsanitize=address,undefined $(SANITIZE)
MODE_cov := -O0 -g --coverage
MODE_mutants := -O2 -fPIC
MODE_fuzz := -O1 -fsanitize=fuzzer-no-link,address,undefined $(SANITIZE)
MODE_web := -O2
MODE_static := -O2
MODE_windows := -O2
MODE_wheel := -O2 -fPIC -fvisibility=hidden
ifeq ($(MODE_$(BUILD)),)
$(error BUILD=$(BUILD) is not one of release debug asan cov fuzz mutants web static windows wheel)
endif
# -ffp-contract=off: no fused multiply-add, so the same digits on every machine
THR_CFLAGS = -std=c11 $(WARN) -ffp-contract=off $(MODE_$(BUILD)) $(CFLAGS)
# gcc's unique symbols would be seen outside of the library
NO_UNIQUE = $(if $(filter %g++,$(CXX)),$(if $(filter fuzz,$(BUILD)),,-fno-gnu-unique))
THR_CXXFLAGS = -std=c++17 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -fno-exceptions -fno-rtti -ffp-contract=off $(NO_UNIQUE) $(MODE_$(BUILD)) $(CXXFLAGS)
THR_CPPFLAGS = -I. -DTHR_VERSION='"$(VERSION)"' $(PKG_CFLAGS) $(CPPFLAGS)
THR_LIBS = $(PKG_LIBS) -lglpk -lm $(LDLIBS)
COMPILER = $(if $(filter fuzz,$(BUILD)),$(FUZZ_CC),$(CC))
# compiles the C++ shim and links everything, since the shim needs the C++ runtime
COMPILER_CXX = $(if $(filter fuzz,$(BUILD)),$(FUZZ_CXX),$(CXX))
LINK = $(COMPILER_CXX) $(MODE_$(BUILD)) $(CFLAGS) $(LDFLAGS)
STRICT = $(if $(filter-out 0,$(WERROR)),$(if $(filter fuzz,$(BUILD)),,-Werror))

DIR := $(OUT)/$(BUILD)
MODULES := graph lp symmetry tortuosity planner eval diagram kit lib
# every module, and its folders by stage
FOLDERS := $(MODULES) $(patsubst %/,%,$(wildcard $(addsuffix /*/,$(MODULES))))
CLI_FOLDERS := cli $(patsubst %/,%,$(wildcard cli/*/))
SOURCES := $(wildcard $(addsuffix /*.c,$(FOLDERS))) $(wildcard $(addsuffix /*.cpp,$(FOLDERS))) diagram/export/viewer_page.S
OBJECTS := $(addsuffix .o,$(basename $(SOURCES:%=$(DIR)/%)))
ifeq ($(BUILD),fuzz)
# what the targets reach: readers, checker, evaluation
OBJECTS := $(filter $(DIR)/graph/% $(DIR)/eval/% $(DIR)/lp/solver/%,$(OBJECTS))
endif
CLI_OBJECTS := $(patsubst %.c,$(DIR)/%.o,$(wildcard $(addsuffix /*.c,$(CLI_FOLDERS))))
# all modules, for the program and for tests, which call any function; in DIST what other programs get
LIBRARY := $(DIR)/$(if $(filter mutants,$(BUILD)),modules.so,modules.a)
SONAME := libthread.so.0
SHARED := $(DIR)/libthread.so.$(VERSION)
STATIC := $(DIR)/libthread.a
PROGRAM := $(DIR)/thread
# tests/*.c is shared by all test programs; each file of tests/unit and tests/property is a program
TEST_SUPPORT := $(patsubst %.c,$(DIR)/%.o,$(wildcard tests/*.c))
TEST_PROGRAMS := $(patsubst %.c,$(DIR)/%,$(wildcard tests/unit/*.c tests/property/*.c))
FUZZ_PROGRAMS := $(patsubst %.c,$(DIR)/%,$(wildcard tests/fuzz/fuzz_*.c))
VALIDATE := $(DIR)/validate
VALIDATE_OBJECTS := $(patsubst %.c,$(DIR)/%.o,$(wildcard tests/validate/*.c))
WATCHDOG := $(DIR)/watchdog
WATCHDOG_OBJECTS := $(patsubst %.c,$(DIR)/%.o,$(wildcard tests/watchdog/*.c))
ifeq ($(BUILD),web)
include web/web.mk
endif
ifeq ($(BUILD),static)
include targets/static.mk
endif
ifeq ($(BUILD),wheel)
include targets/wheel.mk
endif
ifeq ($(BUILD),windows)
include targets/windows.mk
endif
C_FILES = $(wildcard $(foreach d,include web targets targets/windows $(FOLDERS) $(CLI_FOLDERS) tests tests/unit tests/property tests/fuzz tests/second tests/validate tests/watchdog tests/memory docs,$(d)/*.c $(d)/*.h))

Q := $(if $(V),,@)
# `make -jN` given: share its jobs; not given: one per processor
JOBS = $$(case "$$MAKEFLAGS" in *-j*) ;; *) echo -j"$$(nproc)" ;; esac)
quote = '$(subst ','\'',$(1))'

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SECONDARY:
.SUFFIXES:

all: $(PROGRAM) ## build the program (BUILD=release|debug|asan|cov)

shared: $(SHARED)
FOUND_BY := $(addprefix $(DIR)/,thread.pc thread-config.cmake thread-config-version.cmake)
library: $(SHARED) $(STATIC) $(FOUND_BY) ## build libthread, shared and static

demo: ## install what is missing, build, plan a dome, check the plan
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all
	@mkdir -p $(DEMO_OUT)
	$(OUT)/release/thread $(DEMO)
	$(OUT)/release/thread check $(DEMO_OUT)/plan.json
	@echo; echo "plan:    $(DEMO_OUT)/plan.json"
	@for f in $(DEMO_OUT)/*.svg $(DEMO_OUT)/*.pdf $(DEMO_OUT)/*.html; do if [ -e "$$f" ]; then echo "drawing: $$f"; fi; done

test: ## install what is missing, build, run the tests; ends with "N passed, N failed" (ONLY=word runs the matching ones)
test-fast: ## a minute's tests: a tenth of the examples, none of the long jobs
test-rest: ## what `make test` leaves out: sanitizers, the other examples, allocations that fail, the watchdog, fuzzing
test-all: ## everything
fuzz: ## fuzz every reader for FUZZ_SECONDS, keeping what is found in build/fuzz/found
test test-fast test-rest test-all fuzz:
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(TEST_PACKAGES) || { echo "0 passed, 1 failed"; exit 1; }
	+@MAKE="$(MAKE)" OUT="$(OUT)" FUZZ_SECONDS="$(FUZZ_SECONDS)" ONLY="$(ONLY)" CLANG_FORMAT="$(CLANG_FORMAT)" \
	  VIEWER_PACKAGES="$(VIEWER_PACKAGES)" tests/run.sh $(@:test-%=%)

web: ## the program for browsers and node, and thread.html, the page: $(OUT)/web (libraries are built once, some minutes, and kept in LIBRARIES=~/.cache/thread-libraries)
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(WEB_PACKAGES)
	+@$(MAKE) --no-print-directory BUILD=release $(OUT)/packages.ok
	@targets/libraries.sh wasm "$(LIBRARIES)"
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=web LIBRARIES="$(LIBRARIES)" web-files

web-pictures: web ## the pictures in docs/tutorial-page.md, taken by the tests of the page in their browser
	+@tools/install-packages.sh chromium imagemagick
	@tools/npm-packages.sh tests/viewer $(OUT)/web-test/packages
	@rm -rf $(OUT)/web-test/pictures && mkdir -p $(OUT)/web-test/pictures
	@node tests/web/page.cjs $(OUT)/web-test/packages $(OUT)/release/thread $(OUT)/web/thread.html $(OUT)/web-test/pictures
	@for name in questions:640 result:640 telephone:240; do convert $(OUT)/web-test/pictures/$${name%:*}.png -resize $${name#*:}x -colors 96 -strip docs/pictures/page-$${name%:*}.png; done

static: ## the program as one file that runs on any Linux of this processor: $(OUT)/static/thread (libraries as for `make web`)
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	@targets/libraries.sh linux "$(LIBRARIES)"
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=static LIBRARIES="$(LIBRARIES)" all

windows: ## the program as one file for Windows (64 bits): $(OUT)/windows/thread.exe (libraries as for `make web`)
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(WINDOWS_PACKAGES)
	+@$(MAKE) --no-print-directory BUILD=release $(OUT)/packages.ok
	@targets/libraries.sh windows "$(LIBRARIES)"
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=windows LIBRARIES="$(LIBRARIES)" all

wheel: ## the Python package with the library in it, for any Linux as new as this one: $(OUT)/wheel/*.whl (libraries as for `make web`)
	+@tools/install-packages.sh $(BUILD_PACKAGES) python3
	@targets/libraries.sh shared "$(LIBRARIES)"
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=wheel LIBRARIES="$(LIBRARIES)" shared
	@rm -f $(OUT)/wheel/*.whl
	@python3 python/build_wheel.py $(OUT)/wheel $(OUT)/wheel/$(SONAME)

asan: ## build the program with the address and undefined-behaviour sanitizers
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=asan all

formats: ## files by the programs that users export from, read, and written in every format: are the counts right?
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all
	@tests/formats/run.sh $(OUT)/release/thread

layers: ## who may include whom
	@tests/layers.sh

lint: ## clang-format, layers, clang-tidy, cppcheck
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(LINT_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) -k -O format-check layers tidy cppcheck

format-check:
	+@tools/install-packages.sh clang-format
	@$(CLANG_FORMAT) --dry-run -Werror $(C_FILES)

# without those that know another system, whose headers are not here, or have the linker's names
tidy: $(patsubst %.c,$(OUT)/tidy/%.ok,$(filter %.c,$(filter-out tests/% web/host.c targets/libm.c targets/windows/%,$(C_FILES))))
# one file per process: clang-tidy 14 reports every va_list of a second file as uninitialized
$(OUT)/tidy/%.ok: %.c $(filter %.h,$(C_FILES)) .clang-tidy
	@mkdir -p $(@D)
	@if clang-tidy --quiet $< -- -std=c11 $(THR_CPPFLAGS) >$@ 2>/dev/null; then :; else cat $@; rm -f $@; echo "  TIDY  $<: see above" >&2; exit 1; fi

cppcheck:
	@cppcheck --quiet --std=c11 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 \
	  --suppress=missingIncludeSystem '-DEM_JS(type,name,...)=' --suppress=zerodiv:symmetry/lift/keep.c -I. -DTHR_VERSION='"$(VERSION)"' $(filter %.c,$(filter-out tests/%,$(C_FILES)))

format: ## rewrite the sources with clang-format
	+@tools/install-packages.sh clang-format
	@$(CLANG_FORMAT) -i $(C_FILES)

viewer: ## rebuild diagram/export/viewer_page.html from viewer/ (needs npm)
	@mkdir -p $(OUT)
	@viewer/build.sh $(OUT)/viewer > $(OUT)/viewer_page.html
	@mv $(OUT)/viewer_page.html diagram/export/viewer_page.html

docs: ## rewrite the pictures, the gallery and the outputs in docs/tutorial.md with the program (two minutes)
	+@tools/install-packages.sh $(BUILD_PACKAGES) python3 librsvg2-bin poppler-utils
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all
	@tools/make_docs.py $(OUT)/release/thread

bench: ## times of everything, beside other codes (half an hour), write docs/benchmarks.md (BENCH="--only turning": a part)
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(BENCH_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all
	@bench/run.py $(OUT)/release/thread $(or $(BENCH),--output docs/benchmarks.md)

validate: ## measure the pull force against theory, and the thesis's experiments (half an hour), write docs/validation.md, docs/experiments.md
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all $(OUT)/release/validate
	@$(OUT)/release/validate docs/validation.md; first=$$?; \
	tests/validate/claims.py $(OUT)/release/thread docs/validation.md docs/pictures && \
	tests/validate/experiments.py $(OUT)/release/thread docs/experiments.md docs/pictures && exit $$first

memory: ## every command with an allocation of each distinct stack of calls failing (hours; SAMPLES=N: N of each command)
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all $(OUT)/release/tests/memory/fail_malloc.so
	@tests/memory/run.sh $(OUT)/release/thread $(OUT)/release/tests/memory/fail_malloc.so $(OUT)/memory $(or $(SAMPLES),0)

watchdog: ## does every command end in its time, with little memory? The whole matrix (half an hour)
	+@tools/install-packages.sh $(BUILD_PACKAGES)
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=release all $(OUT)/release/watchdog
	@$(OUT)/release/watchdog $(OUT)/release/thread $(OUT)/watchdog --full $(ONLY)

mutants: ## break the checker and others line by line: do the tests notice? MUTANTS=n only so many, ONLY="file.c .." or named
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(TEST_PACKAGES)
	+@MAKE="$(MAKE)" tools/mutants.py --out "$(OUT)" $(if $(MUTANTS),--sample $(MUTANTS)) $(ONLY)

coverage: ## lines and branches reached by the unit and property tests
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(COVERAGE_PACKAGES)
	@rm -rf $(OUT)/cov
	+@$(MAKE) --no-print-directory $(JOBS) BUILD=cov test-programs
	@for t in $(patsubst $(DIR)/%,$(OUT)/cov/%,$(TEST_PROGRAMS)); do CK_TIMEOUT_MULTIPLIER=10 "$$t" | tail -n 1; done
	@gcovr --root . --exclude tests --object-directory $(OUT)/cov

deps: ## install the packages that building needs (apt, as root or with sudo)
	+@tools/install-packages.sh $(BUILD_PACKAGES)

test-deps: ## install the packages that building, testing and linting need
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(TEST_PACKAGES) $(LINT_PACKAGES)

# What `make install` installs where: source and place below DESTDIR.
COMMANDS := plan advise symmetries check eval compare draw kit rise info convert make
MAN_PAGES := $(addprefix $(DIR)/man/,thread.1 $(COMMANDS:%=thread-%.1) libthread.3 thread-plan.5)
# each function's page is libthread(3)
FUNCTIONS = ${shell grep -o 'thread_[a-z_]*(' include/thread.h | tr -d '(' | sort -u}
BIN = $(DESTDIR)$(PREFIX)/bin
SHARE = $(DESTDIR)$(PREFIX)/share
MAN_FOLDERS = $(foreach n,1 3 5,"$(SHARE)/man/man$n")
LIB = $(DESTDIR)$(LIBDIR)
# where the python3 of this system looks for packages below PREFIX
PYTHON_DIR ?= $(or $(shell python3 -c 'import site; print(next(d for d in site.getsitepackages() if d.startswith("$(PREFIX)/lib/python")))' 2>/dev/null),$(PREFIX)/lib/python3/dist-packages)
PACKAGE = $(DESTDIR)$(PYTHON_DIR)/thread_plan

man: $(MAN_PAGES) ## man pages of the commands, of the library and of plan.json
MAN_PAGE = mkdir -p $(@D) && python3 tools/man_page.py $(VERSION) $(DATE)
$(MAN_PAGES): tools/man_page.py Makefile
$(DIR)/man/thread-%.1: $(PROGRAM) tools/man_page.awk
	@$(PROGRAM) $* --help | awk -v command=$* -f tools/man_page.awk > $(DIR)/thread-$*.page
	@$(MAN_PAGE) $(DIR)/thread-$*.page > $@
$(DIR)/man/thread.1: docs/thread.1
	@$(MAN_PAGE) $< > $@
$(DIR)/man/libthread.3: include/thread.h
	@$(MAN_PAGE) $< > $@
$(DIR)/man/thread-plan.5: docs/plan-format.md
	@$(MAN_PAGE) $< > $@

install: all library man ## install program, library, man pages, completions, docs, examples under $(DESTDIR)$(PREFIX)
	install -d "$(PACKAGE)" "$(BIN)" "$(LIB)/pkgconfig" "$(LIB)/cmake/thread" "$(DESTDIR)$(PREFIX)/include" "$(SHARE)/doc/thread" $(MAN_FOLDERS)
	install -m 755 $(PROGRAM) "$(BIN)/thread"
	install -m 755 $(SHARED) "$(LIB)/$(notdir $(SHARED))"
	ln -sf $(notdir $(SHARED)) "$(LIB)/$(SONAME)"
	ln -sf $(SONAME) "$(LIB)/libthread.so"
	install -m 644 $(STATIC) "$(LIB)/libthread.a"
	install -m 644 $(filter %.pc,$(FOUND_BY)) "$(LIB)/pkgconfig/"
	install -m 644 $(filter %.cmake,$(FOUND_BY)) "$(LIB)/cmake/thread/"
	install -m 644 include/thread.h "$(DESTDIR)$(PREFIX)/include/thread.h"
	install -m 644 python/thread_plan/*.py python/thread_plan/py.typed "$(PACKAGE)/"
	$(foreach n,1 3 5,install -m 644 $(filter %.$n,$(MAN_PAGES)) "$(SHARE)/man/man$n/" &&) :
	@for name in $(FUNCTIONS); do ln -sf libthread.3 "$(SHARE)/man/man3/$$name.3"; done
	tools/install_docs.sh "$(SHARE)/doc/thread"
	@if [ -z "$(DESTDIR)" ] && [ "$$(id -u)" = 0 ]; then ldconfig; else echo "thread: run ldconfig as root if the linker does not find libthread.so.0" >&2; fi
	install -D -m 644 completions/thread.bash "$(SHARE)/bash-completion/completions/thread"
	install -D -m 644 completions/_thread "$(SHARE)/zsh/site-functions/_thread"
	install -D -m 644 completions/thread.fish "$(SHARE)/fish/vendor_completions.d/thread.fish"

uninstall: ## remove what `make install` installed
	rm -f "$(BIN)/thread" "$(LIB)"/libthread.so "$(LIB)"/libthread.so.* "$(LIB)/libthread.a" "$(LIB)/pkgconfig/thread.pc" "$(DESTDIR)$(PREFIX)/include/thread.h"
	rm -rf "$(LIB)/cmake/thread"
	rm -f $(foreach n,1 3 5,$(patsubst $(DIR)/man/%,"$(SHARE)/man/man$n/%",$(filter %.$n,$(MAN_PAGES)))) $(FUNCTIONS:%="$(SHARE)/man/man3/%.3")
	rm -f "$(SHARE)/bash-completion/completions/thread" "$(SHARE)/zsh/site-functions/_thread" "$(SHARE)/fish/vendor_completions.d/thread.fish"
	rm -rf "$(SHARE)/doc/thread" "$(PACKAGE)"

TARBALL := $(OUT)/thread-$(VERSION).tar.gz
DEB_PACKAGES := debhelper dh-python fakeroot lintian

dist: ## pack the sources that git has: $(OUT)/thread-VERSION.tar.gz
	@mkdir -p $(OUT)
	git archive --prefix=thread-$(VERSION)/ HEAD | gzip -9n > $(TARBALL)
	@echo $(TARBALL)

# The page is a package if `make web` has built it. Who builds is the maintainer of what is built: DEBFULLNAME and DEBEMAIL.
DEB_PAGE = $(abspath $(wildcard $(OUT)/web/thread.html))
deb: dist ## build the Debian packages below $(OUT)/deb, with thread.html if `make web` was run, and look at them with lintian
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(DEB_PACKAGES)
	rm -rf $(OUT)/deb
	mkdir -p $(OUT)/deb
	tar -xzf $(TARBALL) -C $(OUT)/deb
	$(if $(DEBEMAIL),sed -i 's/thread maintainers <[^>]*>/$(or $(DEBFULLNAME),$(DEBEMAIL)) <$(DEBEMAIL)>/' $(OUT)/deb/thread-$(VERSION)/debian/c[oh]*)
	cd $(OUT)/deb/thread-$(VERSION) && env -u MAKEFLAGS -u MAKELEVEL -u OUT -u BUILD -u CC -u CXX THREAD_HTML="$(DEB_PAGE)" \
	  dpkg-buildpackage -b -us -uc $(if $(DEB_PAGE),--build-profiles=pkg.thread.html)
	lintian --fail-on error $(if $(DEBEMAIL),,--suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog) $(OUT)/deb/*.changes
	@ls $(OUT)/deb/*.deb

# one after another: each shares its jobs
release: export SOURCE_DATE_EPOCH = $(shell git log -1 --format=%ct)
release: ## everything that is handed on, in one folder, with checksums: $(OUT)/thread-VERSION (all of static, windows, web, wheel, deb)
	+@tools/install-packages.sh $(BUILD_PACKAGES) $(WEB_PACKAGES) $(NPM_PACKAGES) $(WINDOWS_PACKAGES) $(DEB_PACKAGES)
	@tools/release.sh --ready "$(LIBRARIES)"
	+@for target in static windows web wheel deb; do $(MAKE) --no-print-directory $$target || exit 1; done
	@tools/release.sh $(VERSION) $(OUT)

clean: ## remove everything made
	rm -rf $(OUT)

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-10s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

# ---- the jobs of tests/run.sh, each after what it needs: make BUILD=asan run/asan/unit/test_read ----

# Each build makes no more than its jobs need. run.sh sets JOBS_release, JOBS_asan and JOBS_fuzz.
suite-release suite-asan suite-fuzz: suite-%: $(OUT)/packages.ok
	+@$(MAKE) BUILD=$* $(JOBS_$*)

GOLDEN_JOBS := $(patsubst tests/%,run/$(BUILD)/%,$(wildcard tests/golden/*.case))
$(TEST_PROGRAMS:$(DIR)/tests/%=run/$(BUILD)/%): run/$(BUILD)/%: $(DIR)/tests/%
$(FUZZ_PROGRAMS:$(DIR)/tests/%=run/%): run/%: $(DIR)/tests/%
run/$(BUILD)/property/test_cross run/$(BUILD)/property/test_cross_known: $(PROGRAM)
run/library/install: $(PROGRAM) $(SHARED) $(STATIC) $(FOUND_BY) $(MAN_PAGES)
run/examples: $(SHARED)
$(GOLDEN_JOBS) run/documents run/readme run/tutorial run/formats/mutants run/examples run/web run/static run/windows run/second/plans run/schema run/slicers run/viewer/browser run/bench/smallest: $(PROGRAM)
# which build what it takes
run/release: run/static run/windows run/web
run/second/json: $(DIR)/tests/second/dump_json
run/$(BUILD)/memory: $(PROGRAM) $(DIR)/tests/memory/fail_malloc.so
run/$(BUILD)/watchdog: $(PROGRAM) $(WATCHDOG)
run/%: FORCE
	@tests/run.sh job $*

test-programs: $(TEST_PROGRAMS)
fuzz-programs: $(FUZZ_PROGRAMS)
list-tests:
	@printf '%s\n' $(patsubst $(DIR)/tests/%,%,$(TEST_PROGRAMS))
list-fuzz:
	@printf '%s\n' $(patsubst $(DIR)/tests/%,%,$(FUZZ_PROGRAMS))
list-flags:
	@printf '%s\n' $(COMPILER) $(THR_CPPFLAGS) $(THR_CFLAGS)
list-c:
	@printf '%s\n' $(C_FILES)

$(PROGRAM): $(CLI_OBJECTS) $(LIBRARY)
	@echo "  LINK  $@"
	$(Q)$(LINK) -o $@ $^ $(THR_LIBS)

$(VALIDATE): $(VALIDATE_OBJECTS) $(LIBRARY)
	@echo "  LINK  $@"
	$(Q)$(LINK) -o $@ $^ $(THR_LIBS)

$(WATCHDOG): $(WATCHDOG_OBJECTS)
	@echo "  LINK  $@"
	$(Q)$(LINK) -o $@ $^ -lm

$(DIR)/tests/second/dump_json: $(DIR)/tests/second/dump_json.o $(LIBRARY)
	@echo "  LINK  $@"
	$(Q)$(LINK) -o $@ $^ $(THR_LIBS)

# for LD_PRELOAD: allocations that fail
$(DIR)/tests/memory/fail_malloc.so: tests/memory/fail_malloc.c $(DIR)/flags.list
	@mkdir -p $(@D)
	@echo "  LINK  $@"
	$(Q)$(COMPILER) $(THR_CFLAGS) $(STRICT) -shared -fPIC -o $@ $<

# a mutated object, loaded before it, takes the place of its own
$(DIR)/modules.so: $(OBJECTS) $(DIR)/objects.list
	@echo "  LINK  $@"
	$(Q)$(LINK) -shared -o $@ $(OBJECTS) $(THR_LIBS)

$(SHARED): $(OBJECTS) $(DIR)/objects.list lib/libthread.map
	@echo "  LINK  $@"
	$(Q)$(LINK) -shared -Wl,-soname,$(SONAME) -Wl,--version-script=lib/libthread.map -Wl,-z,defs -o $@ $(OBJECTS) $(THR_LIBS)
	$(Q)ln -sf $(@F) $(DIR)/$(SONAME)
	$(Q)ln -sf $(SONAME) $(DIR)/libthread.so

# one object, in which all names but thread_* are its own
$(STATIC): $(OBJECTS) $(DIR)/objects.list
	@echo "  AR    $@"
	$(Q)$(LD) -r -o $(DIR)/libthread.o $(OBJECTS)
	$(Q)$(OBJCOPY) --wildcard --keep-global-symbol='thread_*' $(DIR)/libthread.o
	$(Q)rm -f $@
	$(Q)ar rcs $@ $(DIR)/libthread.o

# What pkg-config and CMake read says where things are beside itself, so that what is installed can be moved. Both lie two folders
# below $(LIBDIR) or one.
PREFIX_FROM = $(shell realpath -ms --relative-to="$(LIBDIR)/$1" "$(PREFIX)")
$(DIR)/thread.pc: WITHIN = pkgconfig
$(FOUND_BY): $(DIR)/%: lib/%.in Makefile FORCE
	@mkdir -p $(@D)
	@sed -e 's|@PREFIX_FROM_HERE@|$(call PREFIX_FROM,$(or $(WITHIN),cmake/thread))|; s|@SONAME@|$(SONAME)|; s|@VERSION@|$(VERSION)|; s|@LIBS@|$(THR_LIBS) -lstdc++ -ldl|' $< > $@

$(DIR)/modules.a: $(OBJECTS) $(DIR)/objects.list
	@echo "  AR    $@"
	$(Q)rm -f $@
	$(Q)$(AR) rcs $@ $(OBJECTS)

$(DIR)/%.o: %.c $(DIR)/flags.list
	@mkdir -p $(@D)
	@echo "  CC    $@"
	$(Q)$(COMPILER) $(THR_CPPFLAGS) $(THR_CFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

$(DIR)/%.o: %.cpp $(DIR)/flags.list
	@mkdir -p $(@D)
	@echo "  CXX   $@"
	$(Q)$(COMPILER_CXX) -I. $(BULLET_CFLAGS) $(CPPFLAGS) $(THR_CXXFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

# dense work in long loops, which pays to be unrolled, and in a browser, two numbers at a time, which other processors do unasked
$(addprefix $(DIR)/lp/solver/,normal.o dense.o bundles.o rays.o interior.o cones.o): THR_CFLAGS += $(if $(filter release web static windows wheel,$(BUILD)),-O3) $(if $(filter web,$(BUILD)),-msimd128)

# the viewer's page, as it lies built in the tree, becomes bytes of the program
$(DIR)/%.o: %.S %.html $(DIR)/flags.list
	@mkdir -p $(@D)
	@echo "  AS    $@"
	$(Q)$(COMPILER) $(MODE_$(BUILD)) $(CFLAGS) -c -o $@ $<

$(DIR)/graph/framework/igraph.o $(OUT)/tidy/graph/framework/igraph.ok: private THR_CPPFLAGS += $(LAZY_NAMES)
$(DIR)/eval/structure/spqr.o $(OUT)/tidy/eval/structure/spqr.ok: private THR_CPPFLAGS += $(SPQR_CFLAGS) $(LAZY_NAMES)
$(addprefix $(DIR)/diagram/export/,font_find.o deflate.o) $(addprefix $(OUT)/tidy/diagram/export/,font_find.ok deflate.ok): private THR_CPPFLAGS += $(LAZY_NAMES)
$(TEST_PROGRAMS:%=%.o) $(TEST_SUPPORT): private THR_CPPFLAGS += $(CHECK_CFLAGS)
$(OUT)/mutants/tests/%: private LDFLAGS += -Wl,--wrap=_ck_assert_failed
$(TEST_PROGRAMS): $(DIR)/%: $(DIR)/%.o $(TEST_SUPPORT) $(if $(filter mutants,$(BUILD)),$(DIR)/tools/mutants/stop.o) $(LIBRARY)
	@echo "  LINK  $@"
	$(Q)$(LINK) -o $@ $^ $(CHECK_LIBS) $(THR_LIBS)

$(FUZZ_PROGRAMS): $(DIR)/%: $(DIR)/%.o $(LIBRARY)
	@echo "  LINK  $@"
	$(Q)$(LINK) -fsanitize=fuzzer -o $@ $^ $(THR_LIBS)

# Two lists, rewritten only when they change: other flags recompile everything, a source that is gone leaves the library.
$(DIR)/flags.list: $(OUT)/packages.ok FORCE
	@mkdir -p $(@D)
	@printf '%s\n' $(call quote,$(COMPILER) $(THR_CPPFLAGS) $(THR_CFLAGS) $(COMPILER_CXX) $(BULLET_CFLAGS) $(THR_CXXFLAGS)) | cmp -s - $@ || \
	 printf '%s\n' $(call quote,$(COMPILER) $(THR_CPPFLAGS) $(THR_CFLAGS) $(COMPILER_CXX) $(BULLET_CFLAGS) $(THR_CXXFLAGS)) > $@
$(DIR)/objects.list: FORCE
	@mkdir -p $(@D)
	@echo "$(OBJECTS:$(DIR)/%=%)" | cmp -s - $@ || echo "$(OBJECTS:$(DIR)/%=%)" > $@

$(OUT)/packages.ok:
	@command -v $(CC) >/dev/null && command -v $(CXX) >/dev/null && pkg-config --exists igraph nauty bullet-float64 fontconfig zlib 2>/dev/null && \
	  echo '#include <glpk.h>' | $(CC) -E -x c - >/dev/null 2>&1 || \
	  { echo 'thread: a compiler or a library is missing: run `make deps` (or `make demo`), or install: $(BUILD_PACKAGES)' >&2; exit 1; }
	@mkdir -p $(@D)
	@touch $@

FORCE:
.PHONY: release web web-pictures web-files static shared wheel windows all library man dist deb demo docs formats test test-fast test-rest test-all fuzz asan layers lint format-check tidy cppcheck format viewer bench validate memory watchdog mutants coverage deps test-deps install uninstall clean help
.PHONY: suite-release suite-asan suite-fuzz test-programs fuzz-programs list-tests list-fuzz list-flags list-c FORCE
-include $(wildcard $(DIR)/*/*.d $(DIR)/*/*/*.d)
