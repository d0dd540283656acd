# thread: build, test and install. `make help` lists the targets.
VERSION := 0.1.0
BUILD ?= release
PREFIX ?= /usr/local
DIR := build/$(BUILD)

CC ?= gcc
PACKAGES := igraph jansson
CPPFLAGS := -I. -DTHR_VERSION='"$(VERSION)"' $(shell pkg-config --cflags $(PACKAGES) 2>/dev/null)
WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Wvla
# no fused multiply-add: the same digits on every machine
CFLAGS_release := -O2
CFLAGS_debug := -O0 -g
CFLAGS_asan := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
CFLAGS := -std=c11 $(WARN) -ffp-contract=off $(CFLAGS_$(BUILD)) $(if $(CI),-Werror)
LDLIBS := $(shell pkg-config --libs $(PACKAGES) 2>/dev/null) -lglpk -lm

MODULES := graph lp eval diagram
SOURCES := $(foreach m,$(MODULES),$(wildcard $(m)/*.c))
OBJECTS := $(SOURCES:%.c=$(DIR)/%.o)
CLI_OBJECTS := $(patsubst %.c,$(DIR)/%.o,$(wildcard cli/*.c))
LIBRARY := $(DIR)/libthread.a
PROGRAM := $(DIR)/thread

.DEFAULT_GOAL := all
all: $(PROGRAM)

$(PROGRAM): $(CLI_OBJECTS) $(LIBRARY)
	$(CC) $(CFLAGS) -o $@ $^ $(LDLIBS)

$(LIBRARY): $(OBJECTS)
	rm -f $@
	ar rcs $@ $^

$(DIR)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

clean:
	rm -rf build

.PHONY: all clean
-include $(wildcard $(DIR)/*/*.d)
