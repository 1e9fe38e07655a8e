# retex: one make, not recursive. Every directory with sources has a rules.mk that adds to the lists below.
#   make            the tools, the library and the bridge, into build/
#   make demo       set up, build, render the living room and retexture it
#   make check      set up, build, run all tests
#   make install    PREFIX=/usr/local DESTDIR=

BUILD ?= build
PREFIX ?= /usr/local
DESTDIR ?=
CFLAGS ?= -O2 -g
CXXFLAGS ?= -O2 -g
WARNINGS = -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith -Wvla
CXXWARNINGS = -Wall -Wextra
PKG_CONFIG ?= pkg-config

.DEFAULT_GOAL := all
LIBRETEX_SOURCES :=
RENDERER_SOURCES :=
TOOLS :=
UNIT_TESTS :=

include tools/rules.mk
include renderer/rules.mk
include tests/rules.mk
