# The program that makes the scenes' textures; see scenes/README.md. The files that it makes for the scenes are
# committed: nothing else needs it but what the tests of fidelity retexture with.
TEXTURE_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard scenes/generate/*.c))

$(BUILD)/obj/scenes/%.o: scenes/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS_ALL) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

$(BUILD)/scenes/generate-textures: $(TEXTURE_OBJECTS) $(LIBRETEX) | $(BRIDGE)
	@mkdir -p $(@D)
	$(LINK) $^ -o $@ $(LIBRETEX_LIBS)

# Makes them anew into build/scenes/, to compare, or with TEXTURES=scenes over the committed ones.
TEXTURES ?= $(BUILD)/scenes
.PHONY: textures
textures: $(BUILD)/scenes/generate-textures
	@mkdir -p $(addprefix $(TEXTURES)/,textures $(patsubst %,%/textures,cornell-box glass-caustics kitchen living-room))
	$< $(TEXTURES)

# What the tests of fidelity retexture with. Kept until the program changes.
.PHONY: fidelity-textures
fidelity-textures: $(BUILD)/fidelity/textures/.made
$(BUILD)/fidelity/textures/.made: $(BUILD)/scenes/generate-textures
	@mkdir -p $(@D)
	$< --set fidelity $(@D)
	@touch $@
