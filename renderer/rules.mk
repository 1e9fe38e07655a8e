# The renderer: a library, librender.a (a client of libretex), and its one tool, retex-render.
RENDERER_SOURCES += $(wildcard renderer/*/*.c renderer/*/*/*.c)
LIBRENDER := $(if $(RENDERER_SOURCES),$(BUILD)/lib/librender.a)

$(BUILD)/obj/renderer/%.o: renderer/%.c $(BUILD)/config.mk
	@mkdir -p $(@D)
	$(SAY)$(CC) $(CPPFLAGS_ALL) -Irenderer $(RENDER_CFLAGS) $(CFLAGS_ALL) $(KERNEL_CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/lib/librender.a: $(RENDERER_SOURCES:%.c=$(BUILD)/obj/%.o)
	@mkdir -p $(@D)
	$(SAY)rm -f $@ && $(AR) qcs $@ $^

$(BUILD)/bin/retex-render: $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard renderer/*.c)) $(TOOL_OBJECTS) $(LIBRENDER) $(LIBRETEX) | $(BRIDGE) $(DECODER)
	@mkdir -p $(@D)
	$(SAY)$(LINK) $^ -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS)

ifneq ($(wildcard renderer/retex-render.c),)
TOOLS += retex-render
endif
all: $(LIBRENDER) $(TOOLS:%=$(BUILD)/bin/%)
