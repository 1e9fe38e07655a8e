/* A part of restore_kernel.c, for one kind of numbers: NUMBER is their type, NAME(x) an x of their own. Private to
 * libretex. `bytes` and `bits` are of a residual and of a number. */

/* ---- predicted, where they matter ---- */

/* How one number becomes the next: with shift, in steps. */
static inline NUMBER NAME(step)(int32_t guess, int shift, const unsigned char *from, int bytes, int bits)
{
    guess = add(guess, (1 << shift) >> 1) >> shift;
    return (NUMBER)wrap((int32_t)((uint32_t)add(guess, zigzag_decode(load(from, bytes))) << shift), bits);
}

/* A run of a row; above: the row above and what of it matters, or NULL. Returns the end of its residuals. */
static inline const unsigned char *NAME(restore_run)(NUMBER *n, RetexRowSpan run, const unsigned char *shift,
                                                     const NUMBER *above, const unsigned char *above_present,
                                                     RetexPackPredictor predictor, const unsigned char *from, int bytes,
                                                     int bits, int32_t *last)
{
    int x = run.begin, has_corner = above && above_present[x];
    int32_t guess = predictor == BY_NOTHING ? 0 : has_corner ? above[x] : *last;
    int32_t left = n[x] = NAME(step)(guess, shift ? shift[x] : 0, from, bytes, bits);
    for (x++, from += bytes; x < run.end; x++, from += bytes) {
        const int has_upper = above && above_present[x];
        guess = predictor == BY_NOTHING ? 0 : left;
        if (has_upper && has_corner)
            guess = predict(predictor, left, above[x], above[x - 1]);
        n[x] = NAME(step)(guess, shift ? shift[x] : 0, from, bytes, bits);
        left = n[x];
        has_corner = has_upper;
    }
    *last = left;
    return from;
}

static inline void NAME(restore_runs_by)(const RetexPackPlane *plane, NUMBER *numbers, RetexPackPredictor predictor,
                                         const unsigned char *shift, const unsigned char *from, int bytes, int bits)
{
    const size_t width = (size_t)plane->width;
    int32_t last = 0;
    for (size_t y = 0; y < (size_t)plane->rows; y++) {
        const unsigned char *present = plane->present + y * width;
        NUMBER *n = numbers + y * width;
        for (int k = plane->runs->first[y]; k < plane->runs->first[y + 1]; k++)
            from = NAME(restore_run)(n, plane->runs->run[k], shift ? shift + y * width : NULL, y ? n - width : NULL,
                                     y ? present - width : NULL, predictor, from, bytes, bits, &last);
    }
}

static inline void NAME(restore_runs)(const RetexPackPlane *plane, NUMBER *numbers, RetexPackPredictor predictor,
                                      const unsigned char *shift, const unsigned char *from, int bytes, int bits)
{
    switch (predictor) { /* so that the compiler sees each alone */
    case BY_LEFT:
        NAME(restore_runs_by)(plane, numbers, BY_LEFT, shift, from, bytes, bits);
        break;
    case BY_UPPER:
        NAME(restore_runs_by)(plane, numbers, BY_UPPER, shift, from, bytes, bits);
        break;
    case BY_GRADIENT:
        NAME(restore_runs_by)(plane, numbers, BY_GRADIENT, shift, from, bytes, bits);
        break;
    case BY_MEDIAN:
        NAME(restore_runs_by)(plane, numbers, BY_MEDIAN, shift, from, bytes, bits);
        break;
    default:
        NAME(restore_runs_by)(plane, numbers, BY_NOTHING, shift, from, bytes, bits);
    }
}

/* ---- all numbers, of steps of 1 ---- */

/* All numbers of a row but the first, by one predictor: what most of the time goes to. */
static inline void NAME(restore_row)(NUMBER *n, const NUMBER *above, RetexPackPredictor predictor,
                                     const unsigned char *from, int bytes, int width, int bits)
{
    int32_t left = n[0];
    for (int x = 1; x < width; x++) {
        const int32_t guess = predict(predictor, left, above[x], above[x - 1]);
        n[x] = (NUMBER)wrap(add(guess, zigzag_decode(load(from + x * bytes, bytes))), bits);
        left = n[x];
    }
}

/* Where all numbers matter and have steps of 1. */
static inline void NAME(restore_all)(const RetexPackPlane *plane, NUMBER *numbers, RetexPackPredictor predictor,
                                     const unsigned char *from, int bytes, int bits)
{
    const int width = plane->width;
    for (int y = 0; y < plane->rows; y++) {
        NUMBER *n = numbers + (size_t)y * (size_t)width;
        for (int x = 0; x < (y == 0 ? width : 1); x++) {
            const int32_t guess = predictor == BY_NOTHING ? 0 : x > 0 ? n[x - 1] : y > 0 ? n[-width] : 0;
            n[x] = NAME(step)(guess, 0, from + x * bytes, bytes, bits);
        }
        if (y > 0)
            NAME(restore_row)(n, n - width, predictor, from, bytes, width, bits);
        from += (size_t)width * (size_t)bytes;
    }
}
