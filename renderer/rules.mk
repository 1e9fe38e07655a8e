# The renderer: a library, librender.a (a client of libretex), and its one tool, retex-render.
RENDERER_SOURCES += $(wildcard renderer/base/*.c renderer/sdl/*.c renderer/scene/*.c renderer/shape/*.c renderer/accel/*.c \
	renderer/shade/*.c renderer/light/*.c renderer/integrate/*.c renderer/film/*.c)
LIBRENDER := $(BUILD)/lib/librender.a
EMBREE_LIB ?= $(shell for n in embree4 embree3; do echo "int main(void){return 0;}" | $(CC) -x c - -l$$n -o /dev/null 2>/dev/null && { echo $$n; break; }; done)
RENDER_LIBS = -l$(EMBREE_LIB)

$(BUILD)/obj/renderer/%.o: renderer/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS_ALL) -Irenderer -Itools -DRETEX_$(shell echo $(EMBREE_LIB) | tr a-z A-Z) $(CFLAGS_ALL) -MMD -MP -c $< -o $@

$(LIBRENDER): $(RENDERER_SOURCES:%.c=$(BUILD)/obj/%.o)
	@mkdir -p $(@D)
	rm -f $@ && $(AR) rcs $@ $^

$(BUILD)/bin/retex-render: $(BUILD)/obj/renderer/retex-render.o $(BUILD)/obj/tools/cli.o $(LIBRENDER) $(LIBRETEX) | $(BRIDGE)
	@mkdir -p $(@D)
	$(LINK_TOOL) $^ -o $@ $(RENDER_LIBS) $(LIBRETEX_LIBS)

all: $(LIBRENDER) $(BUILD)/bin/retex-render
