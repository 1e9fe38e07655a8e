# Plugins for OpenImageIO: NAME.imageio.so from NAME_imageio.cpp and the common sources. Each contains the libraries and
# exports only the symbols that OpenImageIO looks up. It loads the bridge from beside it at run time.
PLUGINS := $(patsubst oiio_plugins/%_imageio.cpp,$(BUILD)/plugins/%.imageio.so,$(wildcard oiio_plugins/*_imageio.cpp))
PLUGIN_OBJECTS := $(BUILD)/obj/oiio_plugins/failure.o $(BUILD)/obj/oiio_plugins/set_input.o \
	$(BUILD)/obj/oiio_plugins/own_folder.o $(BUILD)/obj/oiio_plugins/budget.o $(BUILD)/obj/oiio_plugins/set_spec.o
LINK_PLUGIN = $(CXX) -shared $(CXXFLAGS_ALL) $(LDFLAGS) -Wl,--version-script=oiio_plugins/exports.map -Wl,--as-needed

$(BUILD)/obj/oiio_plugins/%.o: oiio_plugins/%.cpp $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CXX) $(CPPFLAGS_ALL) -Irenderer $(BRIDGE_CFLAGS) $(CXXFLAGS_ALL) -Wno-missing-field-initializers -MMD -MP \
	    -c $< -o $@

$(BUILD)/plugins/retex.imageio.so: $(BUILD)/obj/oiio_plugins/retex_imageio.o $(BUILD)/obj/oiio_plugins/pack_source.o \
	    $(PLUGIN_OBJECTS) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK_PLUGIN) $^ -o $@ $(LIBRETEX_LIBS) $(BRIDGE_LIBS)

$(BUILD)/plugins/pov.imageio.so: $(BUILD)/obj/oiio_plugins/pov_imageio.o $(BUILD)/obj/oiio_plugins/scene_source.o \
	    $(BUILD)/obj/oiio_plugins/scene_options.o $(PLUGIN_OBJECTS) $(LIBRENDER) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK_PLUGIN) $^ -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS) $(BRIDGE_LIBS)

INSTALLED += $(PLUGINS:%=755:%:lib/retex/plugins/)

all: $(PLUGINS)
