/* Scripts for compositors that rebuild a retexture from the layers of a set by the program's own nodes. */
#ifndef TOOLS_COMPOSITOR_H
#define TOOLS_COMPOSITOR_H

#include <stdio.h>
#include <retex/set_file.h>

typedef enum CompositorKind { COMPOSITOR_NONE, COMPOSITOR_BLENDER, COMPOSITOR_NUKE } CompositorKind;

/* Whether such scripts can rebuild the set: one target, layout paper. */
int compositor_check(const RetexSet *set, const char *path, RetexError *err);

/* Print the script, which reads the file `layers` that retex_set_write_layers wrote of this set. The set is loaded. */
int compositor_print(FILE *out, CompositorKind kind, const RetexSet *set, const char *layers, RetexError *err);

#endif
