/* A scene that stays open, of which one view after the other is rendered, each better and better: the ray structure and
 * the lights are kept, and samples add up. After N samples a picture is to the bit what render_scene gives with `plain`
 * and an spp of N, but where caustics are guided: of those, with an spp of all samples that the view is to get. */
#ifndef RENDERER_RENDER_LIVE_H
#define RENDERER_RENDER_LIVE_H

#include "camera/view.h"
#include "render/internal.h"

typedef struct LiveRender LiveRender;

/* params: of a plain picture. scene: its camera changes with the view; until the render is closed. */
int live_open(LiveRender **live, Scene *scene, const RenderParams *params, RetexError *err);
void live_close(LiveRender **live);
/* Scene and ray structure as the current view has them. */
FirstHitWindow live_window(const LiveRender *live);
/* What the middle of the scene's own picture shows; where it shows nothing, a point as far as the scene is wide. */
Vec3 live_middle(const LiveRender *live);
void live_bounds(const LiveRender *live, Vec3 *low, Vec3 *high);

/* Turn to a view, NULL: that of the scene's camera. */
int live_look(LiveRender *live, int width, int height, const CameraView *view, RetexError *err);
/* Begin its picture, which is to get so many samples in all. */
int live_begin(LiveRender *live, int spp, RetexError *err);
/* Give all pixels about twice the samples that they have. RETEX_OK too where it was told to stop: then tiles have more
 * or fewer samples, and the next call goes on there. */
int live_improve(LiveRender *live, const StopAsked *stop, RetexError *err);
/* How many samples all pixels have, and how many they are to get. */
int live_samples(const LiveRender *live);
int live_samples_wanted(const LiveRender *live);
/* The picture so far: RGB. */
void live_picture(const LiveRender *live, float *rgb);
/* The same, denoised quickly. RETEX_EINVAL where there are pixels of less than two samples; RETEX_ESTOPPED. */
int live_denoise(LiveRender *live, const StopAsked *stop, float *rgb, RetexError *err);

#endif
