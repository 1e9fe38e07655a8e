/* What a picture's exposure and white balance make of its colours, and the exposure that suits it. See develop.h. */
#include "retexture/develop.h"

#include <math.h>
#include <stdlib.h>

#include <retex/color.h>
#include <retex/lamp.h>

#include "base/params.h"

/* ---- white balance ---- */

/* From Rec.709 to CIE XYZ, and Bradford's matrix from XYZ to the responses of cones. */
static const double rec709_to_xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
static const double bradford[3][3] = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};

static void multiply(double product[3][3], const double a[3][3], const double b[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static void invert(double inverse[3][3], const double m[3][3])
{
    double determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[j][i] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                            m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
    for (int k = 0; k < 3; k++)
        determinant += m[0][k] * inverse[k][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[i][j] /= determinant;
}

/* The matrix of Rec.709 colours that makes white of the light of so many kelvins. */
static void balance(double matrix[3][3], double kelvin)
{
    double to_cones[3][3], back[3][3];
    float light[3];
    multiply(to_cones, bradford, rec709_to_xyz);
    invert(back, to_cones);
    retex_kelvin_color(light, kelvin);
    for (int i = 0; i < 3; i++) {
        double white = 0, lit = 0;
        for (int c = 0; c < 3; c++) {
            white += to_cones[i][c];
            lit += to_cones[i][c] * (double)light[c];
        }
        for (int c = 0; c < 3; c++)
            to_cones[i][c] *= white / lit;
    }
    multiply(matrix, back, to_cones);
}

int retex_developer_open(RetexDeveloper *developer, const RetexDevelop *given, double stops, RetexError *err)
{
    RetexDevelop own = RETEX_DEVELOP_INIT;
    double matrix[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int code = RETEX_PARAMS_COPY(&own, given, err);
    if (code)
        return code;
    if (!(fabs(own.exposure) <= RETEX_EXPOSURE_MAX))
        return retex_fail(err, RETEX_EINVAL, "an exposure is -%d to %d stops, not %g", RETEX_EXPOSURE_MAX,
                          RETEX_EXPOSURE_MAX, own.exposure);
    if (own.white_balance != 0 &&
        !(own.white_balance >= RETEX_WHITE_BALANCE_MIN && own.white_balance <= RETEX_WHITE_BALANCE_MAX))
        return retex_fail(err, RETEX_EINVAL, "a white balance is %d to %d kelvins, not %g", RETEX_WHITE_BALANCE_MIN,
                          RETEX_WHITE_BALANCE_MAX, own.white_balance);
    if (own.white_balance != 0)
        balance(matrix, own.white_balance);
    const double gain = exp2(fmin(fmax(own.exposure + stops, -RETEX_EXPOSURE_MAX), RETEX_EXPOSURE_MAX));
    developer->is_needed = own.white_balance != 0 || gain != 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            developer->matrix[i][j] = (float)(gain * matrix[i][j]);
    return RETEX_OK;
}

/* ---- the exposure of a picture ---- */

int retex_meter_open(RetexMeter *meter, int width, int height, RetexError *err)
{
    *meter = (RetexMeter){.width = (size_t)width, .nstrips = (height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP};
    meter->strips = calloc((size_t)meter->nstrips, sizeof *meter->strips);
    return meter->strips ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to measure a picture");
}

int retex_meter_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    const RetexMeter *meter = context;
    RetexMeterStrip *strip = &meter->strips[y0 / RETEX_PICTURE_STRIP];
    (void)err;
    for (size_t i = meter->width * (size_t)(y1 - y0); i > 0; i--, rows += 3) {
        const float luminance = retex_luminancef(rows[0], rows[1], rows[2]);
        if (!(luminance > 0))
            continue;
        strip->sum += (double)log2f(luminance);
        strip->count++;
    }
    return RETEX_OK;
}

double retex_meter_close(RetexMeter *meter)
{
    static const double GREY = 0.18;
    double sum = 0;
    long count = 0;
    for (int i = 0; i < meter->nstrips && meter->strips; i++) {
        sum += meter->strips[i].sum;
        count += meter->strips[i].count;
    }
    free(meter->strips);
    meter->strips = NULL;
    return count ? fmin(fmax(log2(GREY) - sum / (double)count, -RETEX_EXPOSURE_MAX), RETEX_EXPOSURE_MAX) : 0;
}
