# The library, the bridge to OpenImageIO, OpenColorIO and Little CMS, and the tools.
LIBRETEX_SOURCES += $(wildcard tools/libretex/*/*.c)
TOOLS += retex $(patsubst tools/%.c,%,$(wildcard tools/retex-*.c))

# Only libretex includes the headers of its libraries; only the bridge includes those of OpenImageIO, OpenColorIO and
# Little CMS.
CPPFLAGS_ALL = -Itools/libretex/include -Itools -D_GNU_SOURCE $(if $(DEBUG),-DRETEX_DEBUG) $(CPPFLAGS)
CFLAGS_ALL = -std=c11 -fno-math-errno -ffp-contract=off -fvisibility=hidden -fPIC -pthread $(WARNINGS) \
	$(SAME_ANYWHERE) $(CFLAGS)
CXXFLAGS_ALL = -std=c++17 -ffp-contract=off -fvisibility=hidden -fPIC -pthread $(CXXWARNINGS) \
	$(SAME_ANYWHERE) $(CXXFLAGS)
# Programs do not hold the name of the folder that they are built in, so that they are the same bytes wherever that is:
# a render is resumed only by the program that began it.
SAME_ANYWHERE = '-ffile-prefix-map=$(CURDIR)=.'
# Hot loops (*_kernel.c) are compiled with the vectoriser. The build runs on any x86-64 or ARM: no -march here.
KERNEL_CFLAGS = $(if $(filter %_kernel.c,$<),-fno-math-errno -fno-trapping-math $(if $(filter -O2,$(CFLAGS)),-O3))

LIBRETEX := $(BUILD)/lib/libretex.a
LIBRETEX_SHARED := $(BUILD)/lib/libretex.so.2
BRIDGE := $(BUILD)/lib/libretex-oiio.so
DECODER := $(BUILD)/lib/retex-decode

# One object serves both libraries. Public calls are visible (tools/libretex/include/retex), but nobody may replace them
# inside the library: so they are inlined as in a program.
$(BUILD)/obj/tools/libretex/%.o: tools/libretex/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) -Itools/libretex $(LIBRETEX_CFLAGS) $(CFLAGS_ALL) -fno-semantic-interposition \
	    $(KERNEL_CFLAGS) -MMD -MP -c $< -o $@

# A package may put the bridge and the decoder elsewhere than beside the library: then the library knows the folder.
BRIDGE_FOLDER ?=
ifneq ($(BRIDGE_FOLDER),)
$(BUILD)/obj/tools/libretex/picture/beside.o: CPPFLAGS_ALL += -DRETEX_BRIDGE_FOLDER='"$(BRIDGE_FOLDER)"'
endif

$(BUILD)/obj/tools/%.o: tools/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

$(LIBRETEX): $(LIBRETEX_SOURCES:%.c=$(BUILD)/obj/%.o)
	@mkdir -p $(@D)
	$(SAY)rm -f $@ && $(AR) qcs $@ $^

# The number after .so changes when a program that was linked with the old library would not run with the new one.
$(LIBRETEX_SHARED): $(LIBRETEX_SOURCES:%.c=$(BUILD)/obj/%.o) tools/libretex/libretex.map
	@mkdir -p $(@D)
	$(SAY)$(CC) -shared $(CFLAGS_ALL) $(LDFLAGS) -Wl,-soname,$(@F) -Wl,--version-script=tools/libretex/libretex.map \
	    -Wl,-Bsymbolic-functions -Wl,--as-needed -Wl,--build-id $(filter %.o,$^) -o $@ $(LIBRETEX_LIBS)
$(BUILD)/lib/libretex.so: $(LIBRETEX_SHARED)
	@ln -sf $(<F) $@

$(BUILD)/obj/tools/bridge/%.o: tools/bridge/%.cpp $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CXX) $(CPPFLAGS_ALL) $(BRIDGE_CFLAGS) $(CXXFLAGS_ALL) -MMD -MP -c $< -o $@

$(BRIDGE): $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tools/bridge/*.cpp))
	@mkdir -p $(@D)
	$(SAY)$(CXX) -shared $(CXXFLAGS_ALL) $(LDFLAGS) $^ -o $@ $(BRIDGE_LIBS)

# A tool is tools/retex-NAME.c, tools/common and the library. It contains the library, so that it runs from any
# folder, starts without relocating it, and always is of one version with it. It loads the bridge from beside it at run
# time.
LINK = $(CC) $(CFLAGS_ALL) $(LDFLAGS) -Wl,--build-id
TOOL_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(filter-out %/confine.c,$(wildcard tools/common/*.c)) $(wildcard tools/batch/*.c))
$(BUILD)/bin/retex-%: $(BUILD)/obj/tools/retex-%.o $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

# Pictures of strangers are decoded by a program of its own, which the library starts. It stands beside the bridge.
$(BUILD)/obj/tools/decode/%.o: tools/decode/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) -Itools/libretex $(CFLAGS_ALL) -MMD -MP -c $< -o $@
$(DECODER): $(BUILD)/obj/tools/decode/main.o $(BUILD)/obj/tools/common/confine.o $(LIBRETEX) | $(BRIDGE)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

# retex becomes one of the other tools.
$(BUILD)/bin/retex: $(BUILD)/obj/tools/retex.o $(TOOL_OBJECTS) $(LIBRETEX)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

# What a page loads is one script, which esbuild makes of its first module and all that this imports. The comment at the
# module's head is the script's. The rule of a script has the module first, then the others.
BUNDLE = esbuild --bundle $< --minify --charset=utf8 --legal-comments=none --banner:$(subst .,,$(suffix $@))="$$(sed '/\*\//q' $<)" \
	'--alias:colors=$(abspath $(BUILD)/gen/colors.js)' --log-level=warning --outfile=$@
WEB_MODULES := $(wildcard tools/web/*.js) $(BUILD)/gen/colors.js
$(BUILD)/gen/retex-room.js: tools/web/element.js $(WEB_MODULES) tools/rules.mk
	$(SAY)$(BUNDLE) --format=esm
# The names of colours are those of the library; it has each grey by both spellings.
$(BUILD)/gen/colors.js: tools/libretex/base/color_text.c tools/rules.mk
	@mkdir -p $(@D)
	$(SAY){ printf 'export const COLORS = "'; grep -o '{"[a-z]*", 0x[0-9a-f]*}' $< | grep -v grey | \
	    sed 's/{"\(.*\)", 0x\(.*\)}/\1\U\2/' | tr -d '\n'; echo '";'; } >$@

# The player's files are embedded in retex-pack as bytes.
PLAYER := tools/web/index.html $(BUILD)/gen/retex-room.js $(patsubst %,tools/web/%,retex-room.d.ts package.json README.md)
$(BUILD)/gen/player.c: $(PLAYER) tools/rules.mk
	@mkdir -p $(@D)
	$(SAY){ echo '#include <stddef.h>'; number=0; for file in $(PLAYER); do number=$$((number + 1)); \
	    echo "static const unsigned char file$$number[] = {"; od -An -v -tx1 $$file | sed 's/ \(..\)/0x\1,/g'; \
	    echo '};'; done; \
	    echo 'typedef struct PlayerFile { const char *name; const unsigned char *data; size_t bytes; } PlayerFile;'; \
	    echo 'extern const PlayerFile retex_player_files[]; const PlayerFile retex_player_files[] = {'; number=0; \
	    for file in $(PLAYER); do number=$$((number + 1)); \
	    echo "{\"$${file##*/}\", file$$number, sizeof file$$number},"; done; echo '{NULL, NULL, 0}};'; } >$@
$(BUILD)/obj/gen/player.o: $(BUILD)/gen/player.c
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CFLAGS_ALL) -c $< -o $@
PAGE_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/page/*.c)) $(BUILD)/obj/gen/player.o
$(BUILD)/bin/retex-pack: $(BUILD)/obj/tools/retex-pack.o $(PAGE_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

COMBINE_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/combine/*.c))
$(BUILD)/bin/retex-combine: $(BUILD)/obj/tools/retex-combine.o $(COMBINE_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

TRY_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/try/*.c))
$(BUILD)/bin/retex-try: $(BUILD)/obj/tools/retex-try.o $(TRY_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

# retex-import alone uses Assimp, Draco and meshoptimizer. Draco's headers are of C++: one file of it. With Embree it looks
# for rooms.
EMBREE_CFLAGS = $(filter -DRETEX_EMBREE%,$(RENDER_CFLAGS))
EMBREE_LIBS = $(filter -lembree%,$(RENDER_LIBS))
IMPORT_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/import/*.c tools/import/*/*.c)) $(BUILD)/obj/tools/import/gltf/draco_mesh.o
$(BUILD)/bin/retex-import: $(BUILD)/obj/tools/retex-import.o $(BUILD)/obj/tools/common/confine.o $(IMPORT_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(IMPORT_LIBS) $(EMBREE_LIBS) $(LIBRETEX_LIBS)

$(BUILD)/obj/tools/import/%.o: tools/import/%.cpp $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CXX) $(CPPFLAGS_ALL) $(IMPORT_CFLAGS) $(CXXFLAGS_ALL) -MMD -MP -c $< -o $@
$(BUILD)/obj/tools/import/%.o: tools/import/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) $(LIBRETEX_CFLAGS) $(IMPORT_CFLAGS) $(EMBREE_CFLAGS) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

# retex-serve and retex-studio use libmicrohttpd; tools/http is what they share. retex-serve alone uses Nettle.
HTTP_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/http/*.c))
SERVE_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/serve/*/*.c)) $(HTTP_OBJECTS)
$(BUILD)/bin/retex-serve: $(BUILD)/obj/tools/retex-serve.o $(SERVE_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(SERVE_LIBS) $(LIBRETEX_LIBS)

$(BUILD)/obj/tools/serve/%.o: tools/serve/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) $(SERVE_CFLAGS) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

# retex-studio has the files of its page inside, as bytes; the player among them.
STUDIO_PAGE := tools/studio/web/index.html $(BUILD)/gen/studio.css $(BUILD)/gen/studio.js $(BUILD)/gen/retex-room.js
$(BUILD)/gen/studio.js: tools/studio/web/studio.js $(wildcard tools/studio/web/*.js) tools/rules.mk
	@mkdir -p $(@D)
	$(SAY)$(BUNDLE) --format=esm
$(BUILD)/gen/studio.css: tools/studio/web/studio.css tools/rules.mk
	@mkdir -p $(@D)
	$(SAY)$(BUNDLE)
$(BUILD)/gen/studio_page.c: $(STUDIO_PAGE) tools/rules.mk
	@mkdir -p $(@D)
	$(SAY){ echo '#include "studio/page.h"'; number=0; for file in $(STUDIO_PAGE); do number=$$((number + 1)); \
	    echo "static const unsigned char file$$number[] = {"; od -An -v -tx1 $$file | sed 's/ \(..\)/0x\1,/g'; \
	    echo '};'; done; echo 'const PageFile studio_page[] = {'; number=0; \
	    for file in $(STUDIO_PAGE); do number=$$((number + 1)); \
	    echo "{\"$${file##*/}\", file$$number, sizeof file$$number},"; done; echo '{NULL, NULL, 0}};'; } >$@
$(BUILD)/obj/gen/studio_page.o: $(BUILD)/gen/studio_page.c
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) $(CFLAGS_ALL) -c $< -o $@
STUDIO_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tools/studio/*.c)) $(HTTP_OBJECTS) \
	$(BUILD)/obj/tools/common/confine.o $(BUILD)/obj/gen/studio_page.o
$(BUILD)/bin/retex-studio: $(BUILD)/obj/tools/retex-studio.o $(STUDIO_OBJECTS) $(TOOL_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(SERVE_LIBS) $(LIBRETEX_LIBS)
$(BUILD)/obj/tools/studio/%.o $(BUILD)/obj/tools/retex-studio.o: CPPFLAGS_ALL += $(SERVE_CFLAGS) $(LIBRETEX_CFLAGS)

# systemd looks into this folder, whatever LIBDIR is: the `./` keeps it below PREFIX.
UNIT_PLACE := ./lib/systemd/system/
BRIDGE_PLACE := $(or $(BRIDGE_FOLDER:$(LIBDIR)/%=lib/%),lib)
INSTALLED += 644:$(LIBRETEX):lib/ 755:$(LIBRETEX_SHARED):lib/ link:$(notdir $(LIBRETEX_SHARED)):lib/libretex.so \
	755:$(BRIDGE):$(BRIDGE_PLACE)/ 755:$(DECODER):$(BRIDGE_PLACE)/ \
	$(patsubst %,644:%:include/retex/,$(wildcard tools/libretex/include/retex/*.h)) \
	$(patsubst %,644:%:include/retex/host/,$(wildcard tools/libretex/include/retex/host/*.h)) \
	fill:tools/install/retex.pc.in:lib/pkgconfig/retex.pc \
	fill:tools/install/retexConfig.cmake.in:lib/cmake/retex/retexConfig.cmake \
	fill:tools/install/retexConfigVersion.cmake.in:lib/cmake/retex/retexConfigVersion.cmake \
	644:tools/serve/nginx.conf:share/retex/serve/ 644:tools/blender/retex_export.py:share/retex/blender/ \
	fill:tools/serve/retex-serve.service:$(UNIT_PLACE)

all: $(LIBRETEX) $(BUILD)/lib/libretex.so $(BRIDGE) $(DECODER) $(TOOLS:%=$(BUILD)/bin/%)
-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)
