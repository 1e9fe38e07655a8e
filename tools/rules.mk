# The library, the bridge to OpenImageIO and OpenColorIO, and the tools.
LIBRETEX_SOURCES += $(wildcard tools/libretex/*.c)
TOOLS += retex-sample retex-combine retex-pack retex-diff retex-info

# Only these pass the include path of the libraries they stand for; nothing else in the tree sees them.
PKGS_LIBRETEX = OpenEXR jansson libzip libturbojpeg zlib
PKGS_BRIDGE = OpenImageIO OpenColorIO
pkg_cflags = $(shell $(PKG_CONFIG) --cflags $(1) 2>/dev/null | sed 's/-I/-isystem /g')
pkg_libs = $(shell $(PKG_CONFIG) --libs $(1) 2>/dev/null)

CPPFLAGS_ALL = -Itools/libretex/include -D_GNU_SOURCE $(CPPFLAGS)
CFLAGS_ALL = -std=c11 -fno-math-errno -ffp-contract=off -fvisibility=hidden -fPIC -pthread $(WARNINGS) $(CFLAGS)
CXXFLAGS_ALL = -std=c++17 -fvisibility=hidden -fPIC -pthread $(CXXWARNINGS) $(CXXFLAGS)
LIBRETEX_LIBS = -lOpenEXRCore -ljansson -lzip -lturbojpeg -lz -ldl -lm
EXR_CFLAGS := $(call pkg_cflags,$(PKGS_LIBRETEX))

LIBRETEX := $(BUILD)/lib/libretex.a
BRIDGE := $(BUILD)/lib/libretex-oiio.so
LIBRETEX_OBJECTS = $(LIBRETEX_SOURCES:%.c=$(BUILD)/obj/%.o)

$(BUILD)/obj/tools/%.o: tools/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS_ALL) $(EXR_CFLAGS) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

$(LIBRETEX): $(LIBRETEX_OBJECTS)
	@mkdir -p $(@D)
	rm -f $@ && $(AR) rcs $@ $^

$(BUILD)/obj/tools/bridge/%.o: tools/bridge/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS_ALL) $(call pkg_cflags,$(PKGS_BRIDGE)) $(CXXFLAGS_ALL) -MMD -MP -c $< -o $@

BRIDGE_OBJECTS = $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tools/bridge/*.cpp))
$(BRIDGE): $(BRIDGE_OBJECTS)
	@mkdir -p $(@D)
	$(CXX) -shared $(CXXFLAGS_ALL) $(LDFLAGS) $^ -o $@ $(call pkg_libs,$(PKGS_BRIDGE))

# A tool is tools/retex-NAME.c, the shared command line and the library. The bridge is found beside it at run time.
LINK_TOOL = $(CC) $(CFLAGS_ALL) $(LDFLAGS) -Wl,-rpath,'$$ORIGIN/../lib' -Wl,--disable-new-dtags
$(BUILD)/bin/retex-%: $(BUILD)/obj/tools/retex-%.o $(BUILD)/obj/tools/cli.o $(LIBRETEX) | $(BRIDGE)
	@mkdir -p $(@D)
	$(LINK_TOOL) $^ -o $@ $(LIBRETEX_LIBS)

.PHONY: all
all: $(LIBRETEX) $(BRIDGE) $(TOOLS:%=$(BUILD)/bin/%)
-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)
.SECONDARY:
