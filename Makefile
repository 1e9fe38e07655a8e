# retex: one make, not recursive. Every directory with sources has a rules.mk that adds to the lists below.
#   make              the tools, the library and the bridge, into build/
#   make demo         set up, build, render the living room, denoise and retexture it, into build/demo/
#   make check        set up, build, run a choice of the tests
#   make check-full   all that a change must pass; check-unit, check-cli, … run one suite
#   make check-all    also tests that take long or need heavy programs
#   make check-faults let every allocation, file and thread call fail in turn; ten minutes
#   make check-mutants build each defect of tests/mutants/list.txt; a test must fail
#   make check-branches AREA='film path' COUNT=60 SEED=1   change instructions of compiled files; a test must notice
#   make check-update CASE=golden/NAME   update a golden reference, printing the change
#   make check-debug  run the unit and command-line tests with assertions on
#   make asan, tsan   the same with the sanitizers
#   make fuzz         run mutated inputs with the sanitizers; FUZZ_SECONDS=60 for each kind of input
#   make fuzz-guided  the same guided by coverage, with clang; make fuzz-coverage: what of parsers they reach
#   make bench        print ratios of speed: kernels against references, sets against plain renders
#   make bench-render speed and error of rendering, compared with Cycles and with Embree's rays alone; docs/speed.md
#   make bench-overhead   time of sets over plain pictures, as in the paper; BENCH_DOCS=1: docs/overhead.md
#   make bench-post   time of retextures and size of sets, as in the paper; BENCH_DOCS=1: docs/post.md
#   make bench-paper  size of the paper's AOVs and of ours; BENCH_DOCS=1: docs/paper-sizes.md
#   make bench-storage    size and loss of sets and packs; BENCH_DOCS=1: docs/storage.md
#   make bench-catalogues   pictures a second of --batch, and what a million a day takes; BENCH_DOCS=1: docs/catalogues.md
#   make bench-serve  processor time of retex-serve's answers; BENCH_DOCS=1: docs/serve.csv, the figures of docs/serve.md
#   make bench-scale  time per path by triangles, lights, targets and resolution; BENCH_DOCS=1: docs/scale.md
#   make parity       compare POV-Ray's sample scenes with POV-Ray; SCENES='chess2 camera/' selects scenes by parts of
#                     their names; BENCH_DOCS=1: docs/parity.md
#   make fidelity     compare retextures with new renders; BENCH_DOCS=1: docs/fidelity.md; takes hours
#   make fidelity-denoise   compare denoised sets with new renders; BENCH_DOCS=1: docs/denoise.md; takes hours
#   make fidelity-frames    whether frames of an animation flicker; BENCH_DOCS=1: docs/frames.md; takes an hour
#   make fidelity-rooms     imported rooms of $RETEX_ROOMS beside Cycles and new renders: docs/imported-rooms.md
#   make figures      the pages of measured figures in docs/, and those figures in README and man pages;
#                     in at most 100 minutes; PAGES='post speed', FULL=1 for large pictures and the paper's sizes
#   make pictures     make the README's pictures in docs/pictures; takes long
#   make compare-external DIR=FOLDER   score another method's pictures against the references; sheets in build/external
#   make lint         check the project's rules that a script can check
#   make format       run clang-format on the sources
#   make install      PREFIX=/usr/local LIBDIR=PREFIX/lib DESTDIR=; make uninstall, with the same, removes it
#   make deb          Debian packages, into build/deb
# A missing compiler or library is installed first if permitted: tools/setup.sh.

# DEBUG=1: a build of its own in which assertions are checked (retex/host/assert.h).
DEBUG =
BUILD ?= build$(if $(DEBUG),/debug)
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
DESTDIR ?=
CFLAGS ?= -O2 -g
CXXFLAGS ?= -O2 -g
WARNINGS = -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith -Wvla \
	-Wno-missing-field-initializers # rows of tables leave out what is 0
CXXWARNINGS = -Wall -Wextra
VERSION := $(shell sed -n 's/.* RETEX_VERSION "\(.*\)"$$/\1/p' tools/libretex/include/retex/version.h)
PKG_CONFIG ?= pkg-config
INSTALL ?= install
# V=1 prints whole commands.
V ?= 0
SAY = $(if $(filter 0,$(V)),@echo '  $@' && )
# -j on the command line has precedence; a recursive make shares its jobs.
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(JOBS)
endif

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SECONDARY:
LIBRETEX_SOURCES :=
RENDERER_SOURCES :=
TOOLS :=
INSTALLED :=

# The flags of the libraries, written after set-up. make then reads all makefiles again, so a machine that lacked
# packages builds in the same run. `make clean` and `make format` do not need them.
ifneq ($(filter-out clean format uninstall deb,$(or $(MAKECMDGOALS),all)),)
include $(BUILD)/config.mk
endif
$(BUILD)/config.mk: tools/setup.sh
	@mkdir -p $(@D)
	@tools/setup.sh build
	@tools/setup.sh config >$@

include tools/rules.mk
include renderer/rules.mk
include oiio_plugins/rules.mk
include scenes/rules.mk
include completions/rules.mk
include tests/rules.mk

.PHONY: all demo pictures install uninstall deb clean lint format
demo: all
	@tools/demo.sh $(BUILD)
pictures: all
	@tools/pictures.sh $(BUILD) && tools/page-pictures.sh $(BUILD)

# What is installed: MODE:SOURCE:PLACE, see tools/install.sh. Each rules.mk adds its own.
INSTALLED += $(TOOLS:%=755:$(BUILD)/bin/%:bin/) \
	$(foreach page,$(wildcard man/*.[1-9]),644:$(page):share/man/man$(subst .,,$(suffix $(page)))/)
# A page of calls is found by the name of each.
INSTALLED += $(shell awk '/^\.Sh SYN/ { nextfile } /^\.Nm/ { sub(/.*\//, "", FILENAME); name = $$2 ".3"; \
	if (name != FILENAME) print "link:" FILENAME ":share/man/man3/" name }' man/*.3)
space := $(subst ,, )
RUN_INSTALL = PREFIX='$(PREFIX)' LIBDIR='$(LIBDIR)' DESTDIR='$(DESTDIR)' INSTALL='$(INSTALL)' \
	VERSION='$(VERSION)' REQUIRES='$(LIBRETEX_REQUIRES)' LIBS='$(strip $(LIBRETEX_PRIVATE_LIBS))' \
	STATIC_LIBS='$(subst $(space),;,$(strip $(LIBRETEX_LIBS) -pthread))' tools/install.sh
install: all
	@$(RUN_INSTALL) install $(INSTALLED)
uninstall:
	@$(RUN_INSTALL) uninstall $(INSTALLED)
# Debian packages, into $(BUILD)/deb.
deb:
	@tools/deb.sh $(BUILD)/deb

lint:
	@tests/lib/lint.sh

format:
	clang-format -i $$(git ls-files '*.c' '*.cpp' 'oiio_plugins/*.hpp')

clean:
	rm -rf $(BUILD)
