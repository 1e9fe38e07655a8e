/* See stored.h. */
#include "exr/stored.h"

int retex_exr_stored_find(RetexExrStored *stored, RetexExr *exr, const RetexExrPlan *plan, RetexPixelType type)
{
    const exr_pixel_type_t stored_type = type == RETEX_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    const int pxr24 = plan->compression == EXR_COMPRESSION_PXR24;
    const int packed = plan->compression == EXR_COMPRESSION_ZIP || (pxr24 && type == RETEX_FLOAT);

    if (!packed || plan->storage != EXR_STORAGE_SCANLINE || plan->chunk_height != RETEX_CHUNK_LINES ||
        !plan->request->bands)
        return 0;
    for (int c = 0; c < plan->nchannels; c++)
        if (plan->image_channel[c] < 0 || plan->channels[c].pixel_type != stored_type ||
            plan->channels[c].x_sampling != 1 || plan->channels[c].y_sampling != 1)
            return 0;
    *stored = (RetexExrStored){.exr = exr,
                               .part = plan->request->part,
                               .top = plan->top,
                               .width = plan->width,
                               .height = plan->height,
                               .pixel_bytes = plan->pixel_bytes,
                               .pxr24 = pxr24,
                               .crc = plan->request->expected,
                               .bands = plan->request->bands};
    return 1;
}

int retex_exr_stored_chunk(const RetexExrStored *stored, int y, uint64_t *offset, size_t *bytes)
{
    const int rest = stored->height - y, lines = rest < RETEX_CHUNK_LINES ? rest : RETEX_CHUNK_LINES;
    const size_t most = (size_t)stored->width * (size_t)lines * stored->pixel_bytes;
    exr_chunk_info_t chunk;

    if (exr_read_scanline_chunk_info(stored->exr->context, stored->part, stored->top + y, &chunk) ||
        chunk.packed_size == 0 || chunk.packed_size > most || chunk.unpacked_size != most)
        return 0;
    *offset = chunk.data_offset;
    *bytes = (size_t)chunk.packed_size;
    return 1;
}

int retex_exr_stored_fail(const RetexExrStored *stored, RetexError *err)
{
    const RetexInput *input = stored->exr->input;
    const int code = retex_fail(err, RETEX_EFORMAT, "%s: part %s is damaged or truncated", retex_input_name(input),
                                  retex_exr_part_name(stored->exr, stored->part));

    return retex_input_check(input, code, err);
}

int retex_exr_stored_read(const RetexExrStored *stored, uint64_t offset, size_t bytes, unsigned char *to,
                          RetexError *err)
{
    if (retex_input_read(stored->exr->input, to, bytes, offset) != (int64_t)bytes)
        return retex_exr_stored_fail(stored, err);
    return RETEX_OK;
}
