# Tests: see tests/README.md.
UNIT_TESTS := $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/test_*.c))
LIBTEST := $(BUILD)/tests/libtest.a
FUZZ_PROGRAMS := $(patsubst tests/fuzz/%.c,$(BUILD)/tests/fuzz/%,$(wildcard tests/fuzz/fuzz_*.c))
FUZZ_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tests/fuzz/lib_*.c))
BENCH_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tests/bench/bench*.c))
# Tests take packs apart with a zip library that is not ours.
TEST_LIBS = -lzip
FAULTS := $(BUILD)/tests/faults/shim.so $(BUILD)/tests/faults/faults
TEST_PROGRAMS := $(patsubst tests/lib/%.c,$(BUILD)/tests/bin/%,$(wildcard tests/lib/make_*.c))

$(BUILD)/test.mk: tools/setup.sh
	@mkdir -p $(@D)
	@tools/setup.sh test
	@touch $@

$(LIBTEST): $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tests/lib/lib_*.c))
	@mkdir -p $(@D)
	$(SAY)rm -f $@ && $(AR) qcs $@ $^

# Unit tests may look inside: they see the libraries' private headers.
$(BUILD)/obj/tests/%.o: tests/%.c $(BUILD)/config.mk | $(BUILD)/test.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) -Itests/lib -Itools/libretex -Irenderer $(LIBRETEX_CFLAGS) $(RENDER_CFLAGS) \
	    $(CFLAGS_ALL) -MMD -MP -c $< -o $@

$(BUILD)/tests/unit/%: $(BUILD)/obj/tests/unit/%.o $(LIBTEST) $(TOOL_OBJECTS) $(LIBRENDER) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $(filter %.o,$^) $(filter-out %.o,$^) -o $@ -lcmocka $(RENDER_LIBS) $(LIBRETEX_LIBS) $(TEST_LIBS)

$(BUILD)/tests/unit/test_confine: $(BUILD)/obj/tools/common/confine.o
$(BUILD)/tests/unit/test_beneath: $(BUILD)/obj/tools/common/beneath.o
# What retex-import asks of a model's surfaces, and its transforms, are tested without Assimp.
$(BUILD)/tests/unit/test_import_space: $(patsubst %,$(BUILD)/obj/tools/import/space/%.o,space room picture score views)
$(BUILD)/tests/unit/test_import_base: $(BUILD)/obj/tools/import/base/affine.o
$(BUILD)/tests/unit/test_serve: private TEST_LIBS += $(SERVE_LIBS)
# What URLs mean to retex-serve is tested without a server.
SERVE_URL_OBJECTS := $(patsubst %,$(BUILD)/obj/tools/serve/request/%.o,hints iiif name parse request url)
$(BUILD)/tests/unit/test_serve_request $(BUILD)/tests/unit/test_serve_iiif: $(SERVE_URL_OBJECTS)
$(BUILD)/tests/unit/test_serve_clients: $(patsubst %,$(BUILD)/obj/tools/%.o,serve/clients/address serve/clients/clients http/head serve/clients/peers)
$(BUILD)/tests/unit/test_serve: $(SERVE_URL_OBJECTS) \
	$(patsubst %,$(BUILD)/obj/tools/serve/%.o,answer/answer answer/cache site/work http/body) \
	$(BUILD)/obj/tools/http/headers.o $(patsubst %,$(BUILD)/obj/tools/serve/files/%.o,names kept content decoding images rooms uploads)
# And the parts of retex-studio: who may ask, command lines, files.
$(BUILD)/tests/unit/test_studio: private TEST_LIBS += $(SERVE_LIBS)
$(BUILD)/tests/unit/test_studio: $(patsubst %,$(BUILD)/obj/tools/studio/%.o,gate places changes job_line project_parse received media reply) $(BUILD)/obj/tools/http/headers.o
$(BUILD)/tests/fuzz/fuzz_request: $(BUILD)/obj/tests/fuzz/fuzz_request.o $(FUZZ_OBJECTS) $(SERVE_URL_OBJECTS) \
	    $(BUILD)/obj/tools/common/json.o $(BUILD)/obj/tools/common/json_text.o $(LIBTEST) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS) $(TEST_LIBS) $(FUZZ_LIBS)

$(BUILD)/tests/bin/%: $(BUILD)/obj/tests/lib/%.o $(LIBTEST) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS) $(TEST_LIBS)

$(BUILD)/tests/bin/make_tiffs: private TEST_LIBS += -ltiff

$(BUILD)/tests/fuzz/fuzz_%: $(BUILD)/obj/tests/fuzz/fuzz_%.o $(FUZZ_OBJECTS) $(LIBTEST) $(LIBRENDER) $(LIBRETEX) \
	    | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $(filter %.o,$^) $(filter-out %.o,$^) -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS) $(TEST_LIBS) $(FUZZ_LIBS)

$(BUILD)/obj/tests/fuzz/fuzz_gltf.o: RENDER_CFLAGS += $(IMPORT_CFLAGS)
$(BUILD)/tests/fuzz/fuzz_gltf: $(BUILD)/obj/tests/fuzz/fuzz_gltf.o $(FUZZ_OBJECTS) $(IMPORT_OBJECTS) $(TOOL_OBJECTS) \
	    $(LIBTEST) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(IMPORT_LIBS) $(EMBREE_LIBS) $(LIBRETEX_LIBS) $(TEST_LIBS) $(FUZZ_LIBS)
$(BUILD)/tests/fuzz/fuzz_upload: TEST_LIBS += $(SERVE_LIBS)
$(BUILD)/tests/fuzz/fuzz_upload: $(TOOL_OBJECTS) $(patsubst %,$(BUILD)/obj/tools/%.o,studio/received serve/answer/answer \
	serve/request/name serve/files/uploads serve/files/decoding serve/files/kept serve/files/names serve/files/content)
# It runs the tools, and has models from Assimp.
$(BUILD)/tests/fuzz/fuzz_import: TEST_LIBS += -lassimp
$(BUILD)/tests/fuzz/fuzz_import: | $(addprefix $(BUILD)/bin/,retex-import retex-render)

$(BUILD)/tests/bench/bench: $(BENCH_OBJECTS) $(LIBTEST) $(LIBRENDER) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS) $(TEST_LIBS)

# The player's functions for tests without a browser, made as the player is.
$(BUILD)/tests/web/player.js: tests/web/modules.js $(WEB_MODULES) tools/rules.mk
	$(SAY)$(BUNDLE) --global-name=player

# Stands before the C library, so it knows it well; and its driver.
$(BUILD)/tests/faults/shim.so: tests/faults/shim.c
	@mkdir -p $(@D)
	$(SAY)$(CC) -std=gnu11 -O2 -g $(WARNINGS) -Wno-missing-prototypes -shared -fPIC $< -o $@ -ldl
$(BUILD)/tests/faults/faults: tests/faults/faults.c
	@mkdir -p $(@D)
	$(SAY)$(CC) -std=gnu11 -O2 -g $(WARNINGS) $< -o $@ -lz

# Stands in for Open Image Denoise 2, and for one that lacks a function.
OIDN_STAND_INS := $(BUILD)/tests/oidn/libOpenImageDenoise.so.2 $(BUILD)/tests/oidn/older.so
$(BUILD)/tests/oidn/older.so: private CPPFLAGS += -DOLDER
$(OIDN_STAND_INS): tests/oidn/stand_in.c tests/oidn/stand_in.h
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS) -std=gnu11 -O2 -g $(WARNINGS) -Wno-missing-prototypes -shared -fPIC $< -o $@ -lm
$(BUILD)/tests/unit/test_denoise_oidn: | $(OIDN_STAND_INS)

# What make bench-post measures by: each is one file.
$(BUILD)/tests/bench/post_%: $(BUILD)/obj/tests/bench/post_%.o $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

$(BUILD)/tests/bench/embree_rays: $(BUILD)/obj/tests/bench/embree_rays.o $(LIBTEST) $(LIBRENDER) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS) $(TEST_LIBS)

.PHONY: unit-tests test-programs suite-programs tests check check-suites check-full check-all check-debug check-faults check-mutants check-branches check-unit check-cli check-web check-oiio check-python check-golden check-man check-docs check-fidelity check-long check-update \
	asan tsan bench fuzz fuzz-guided fuzz-coverage fuzz-programs sanitized-fuzz guided-fuzz guided-programs
unit-tests: $(UNIT_TESTS:%=$(BUILD)/tests/unit/%)
test-programs: $(TEST_PROGRAMS) $(OIDN_STAND_INS) $(BUILD)/tests/web/player.js all
# What the suites run; fuzzing and benchmarks are built beside them, so that they go on compiling.
suite-programs: test-programs $(FAULTS) unit-tests
tests: suite-programs fuzz-programs $(BUILD)/tests/bench/bench

# Suites are run by tests/lib/check.sh, which adds up what they report.
SUITES ?= lint unit cli web oiio python man docs golden faults fidelity
RUN_CHECK = BUILD=$(BUILD) JOBS=$(JOBS) tests/lib/check.sh
# check runs those of tests/quick.txt, which tests/mutants/quick.py chooses; one more at a time, as some wait.
check: suite-programs
	@BUILD=$(BUILD) JOBS=$$(($(JOBS) + 1)) tests/lib/check.sh quick
check-suites: suite-programs
	@$(RUN_CHECK) $(SUITES)
check-full: tests
	@$(RUN_CHECK) $(SUITES)
check-all: tests sanitized-fuzz
	@$(MAKE) check-debug
	@tools/setup.sh cluster || true # long/cluster.sh tells what is missing
	@MUTANTS=all RETEX_FAULTS=all $(RUN_CHECK) $(SUITES) long mutants
# With assertions on.
DEBUG_SUITES ?= unit cli
check-debug:
	$(MAKE) BUILD=$(BUILD)/debug DEBUG=1 SUITES='$(DEBUG_SUITES)' check-suites
# Every call that can fail does, in turn; every small wrongness of tests/mutants/list.txt must be noticed.
check-mutants: tests
	@MUTANTS="$${MUTANTS:-all}" $(RUN_CHECK) mutants
# Instructions of compiled files, changed one at a time: in a build at -O1, with another that counts what tests reach.
AREA ?= all
check-branches:
	@[ "$$(uname -m)" = x86_64 ] || exit 0; \
	$(MAKE) BUILD=$(BUILD)/branches/plain CFLAGS='-O1 -g -save-temps=obj' CXXFLAGS='-O1 -g' all unit-tests test-programs && \
	$(CC) -O1 -fPIC -c tests/branches/covered.c -o $(BUILD)/branches/covered.o && \
	$(MAKE) BUILD=$(BUILD)/branches/covered CFLAGS='-O1 -g --coverage' CXXFLAGS='-O1 -g' \
	    LDFLAGS='--coverage -Wl,--wrap=_exit,--wrap=confine_to_folder $(abspath $(BUILD))/branches/covered.o' \
	    CPPFLAGS=-D__SANITIZE_ADDRESS__ all unit-tests test-programs # the decoder must be free to write what it counted
	@BUILD=$(BUILD) tests/branches/run.py $(AREA)
check-faults: tests
	@RETEX_FAULTS=all $(RUN_CHECK) faults
check-unit check-cli check-web check-python check-man check-docs check-golden check-fidelity: tests
	@$(RUN_CHECK) $(@:check-%=%)
check-long: tests sanitized-fuzz
	@$(RUN_CHECK) long
check-update: tests
	@BUILD=$(BUILD) tests/lib/update.sh '$(CASE)'

# Assertions are on in these builds, too: fuzzing looks for inputs that break them.
SANITIZED = DEBUG=1 CFLAGS='-O1 -g -fno-omit-frame-pointer -fsanitize=$(1)' CXXFLAGS='-O1 -g -fsanitize=$(1)' \
	LDFLAGS='-fsanitize=$(1)'
ADDRESS_SANITIZED = BUILD=$(BUILD)/asan $(call SANITIZED,address$(comma)undefined -fno-sanitize-recover=undefined)
# Freed memory that is kept aside would count in tests of peak memory. The leak checker takes the thread-local memory of
# libraries that are opened later for what it is not, and crashes (its log, verbosity=1: "DTLS 8 at 0x1d17").
asan:
	ASAN_OPTIONS=quarantine_size_mb=16:intercept_tls_get_addr=0 \
	LSAN_OPTIONS=suppressions=$(CURDIR)/tests/lib/lsan.supp:print_suppressions=0 \
	    $(MAKE) $(ADDRESS_SANITIZED) SUITES='unit cli' check-suites
# Models are read by a process that has been forked, and may have threads.
tsan:
	TSAN_OPTIONS='die_after_fork=0 ignore_noninstrumented_modules=1 suppressions=$(CURDIR)/tests/lib/tsan.supp' \
	    $(MAKE) BUILD=$(BUILD)/tsan $(call SANITIZED,thread) SUITES='unit cli' check-suites
comma := ,

# FUZZ_SECONDS a driver; FUZZ_SEED=N repeats a run; FUZZ='scene pack' chooses. Findings are kept in $(BUILD)/fuzz.
FUZZ_SECONDS ?= 60
fuzz: sanitized-fuzz
	@BUILD=$(BUILD)/asan KEEP=$(BUILD)/fuzz tests/fuzz/run.sh $(FUZZ_SECONDS) '$(FUZZ_SEED)' $(FUZZ)
sanitized-fuzz: | $(BUILD)/test.mk
	$(MAKE) $(ADDRESS_SANITIZED) fuzz-programs
# The same drivers guided by coverage, by clang's libFuzzer, from the corpora of tests/fuzz/corpus on.
GUIDED_SANITIZED = BUILD=$(BUILD)/guided CC=clang CXX=clang++ $(call SANITIZED,address$(comma)undefined$(comma)fuzzer-no-link \
	-fno-sanitize-recover=undefined) FUZZ_LIBS="-Wl,-u,LLVMFuzzerRunDriver $$(clang -print-file-name=libclang_rt.fuzzer_no_main-$$(uname -m).a) -lstdc++ -fsanitize-link-c++-runtime"
# With all that it takes minutes to compile vector code for several processors.
ifneq ($(FUZZ_LIBS),)
$(BUILD)/obj/%_kernel.o: private override CFLAGS += -fno-sanitize=all
endif
fuzz-guided: guided-fuzz
	@BUILD=$(BUILD)/guided KEEP=$(BUILD)/fuzz tests/fuzz/guided.sh $(FUZZ_SECONDS) $(FUZZ)
guided-fuzz: | $(BUILD)/test.mk
	@tools/setup.sh guided
	$(MAKE) $(GUIDED_SANITIZED) guided-programs
guided-programs: $(filter-out %_import,$(FUZZ_PROGRAMS)) $(BUILD)/tests/bin/make_picture
# The share of each parser's branches that the corpora reach.
fuzz-coverage: guided-fuzz
	@BUILD=$(BUILD)/guided tests/fuzz/coverage.sh $(FUZZ)
fuzz-programs: $(FUZZ_PROGRAMS) $(TEST_PROGRAMS) $(BUILD)/lib/libretex.so $(BUILD)/bin/retex-pack $(BUILD)/tests/web/player.js

bench: $(BUILD)/tests/bench/bench
	@mkdir -p $(BUILD)/bench
	@$< scenes $(BUILD)/bench

# Rendering against Cycles, where blender is there, and against Embree alone: $(BUILD)/bench/render.txt.
.PHONY: bench-render
bench-render: all $(BUILD)/tests/bench/embree_rays
	@BUILD=$(BUILD) tests/bench/render/run.sh

# POV-Ray's samples against POV-Ray: SCENES='…' chooses, BENCH_DOCS=1 puts the table of all into docs/.
.PHONY: parity
parity: all | $(BUILD)/test.mk
	@tools/setup.sh parity
	@BUILD=$(BUILD) SCENES='$(SCENES)' tests/parity/run.sh

# What sets cost over plain pictures, and how costs grow; BENCH_DOCS=1 puts the pages into docs/.
.PHONY: bench-overhead bench-scale
bench-overhead: all
	@BUILD=$(BUILD) tests/bench/overhead/run.sh
bench-scale: all
	@BUILD=$(BUILD) tests/bench/scale/run.sh

# How long retextures take and how large sets are, as in the paper's tables; and size against loss of packs.
POST_PROGRAMS := $(BUILD)/tests/bench/post_floor $(BUILD)/tests/bench/post_measure
.PHONY: bench-post bench-storage bench-paper bench-serve bench-catalogues bench-web paper-tables
paper-tables:
	@. tests/figures/head.sh; /usr/bin/python3 -B tests/bench/paper_tables.py docs "$$(figures_head paper-tables)" \
	    >docs/paper-tables.md
bench-web: all
	@BUILD=$(BUILD) tests/bench/web/run.sh
bench-post: all $(POST_PROGRAMS)
	@BUILD=$(BUILD) tests/bench/post/run.sh
bench-storage: all fidelity-textures
	@BUILD=$(BUILD) tests/bench/post/storage.sh
bench-paper: all
	@BUILD=$(BUILD) tests/bench/post/paper.sh
bench-serve: all
	@BUILD=$(BUILD) tests/bench/serve/run.sh
bench-catalogues: all $(POST_PROGRAMS) $(BUILD)/tests/bin/make_set
	@BUILD=$(BUILD) tests/bench/catalogues/run.sh

# Retextures against rendering again, in all scenes; what denoising gains. Each takes hours; FIDELITY_… and DENOISE_… of
# the scripts choose less.
.PHONY: fidelity fidelity-denoise fidelity-frames fidelity-lamps fidelity-finishes fidelity-maps fidelity-normals fidelity-edits fidelity-rooms fidelity-models fidelity-first fidelity-blender
fidelity: all fidelity-textures
	@BUILD=$(BUILD) tests/fidelity/table/run.sh
fidelity-denoise: all fidelity-textures
	@BUILD=$(BUILD) tests/fidelity/table/denoise.sh
fidelity-frames: all
	@BUILD=$(BUILD) tests/fidelity/table/frames.sh
fidelity-lamps: all
	@BUILD=$(BUILD) tests/fidelity/table/lamps.sh
fidelity-finishes: all
	@BUILD=$(BUILD) tests/fidelity/table/finishes.sh
fidelity-maps: all
	@BUILD=$(BUILD) tests/fidelity/table/finish-maps.sh
fidelity-normals: all
	@BUILD=$(BUILD) tests/fidelity/table/normal-maps.sh
fidelity-first: all
	@BUILD=$(BUILD) tests/fidelity/table/first-pictures.sh
fidelity-models: all
	@BUILD=$(BUILD) tests/fidelity/table/models.sh
fidelity-edits: all
	@BUILD=$(BUILD) tests/fidelity/table/edits.sh
fidelity-blender: all
	@BUILD=$(BUILD) tests/fidelity/table/blender-features.sh
fidelity-rooms: all
	@BUILD=$(BUILD) tests/fidelity/table/imported-rooms.sh

# The pages with measured figures in docs/, and the figures of README and man pages from them. PAGES='…' chooses.
.PHONY: figures
figures: all
	@BUILD=$(BUILD) PAGES='$(PAGES)' FULL='$(FULL)' tests/figures/run.sh

# The pictures of docs/studio.md and the recording of README.md, by a walk through the page in Chromium.
.PHONY: figures-studio
figures-studio: all
	@tools/setup.sh web
	PATH="$(abspath $(BUILD)/bin):$$PATH" /usr/bin/python3 -B tests/studio/shots.py docs/pictures

# How another method fares: DIR holds its pictures SCENE-TEXTURE.png; the truths are the fidelity run's.
.PHONY: compare-external
compare-external: all
	@BUILD=$(BUILD) tests/external/compare.sh '$(DIR)'
