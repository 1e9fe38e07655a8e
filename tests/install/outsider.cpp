// The same program in C++, with objects that close themselves. outsider SET TARGET=IMAGE OUTPUT
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include <retex/retex.h>

template <class T, void (*close)(T **)> struct Closer {
    void operator()(T *object) const { close(&object); }
};
using Set = std::unique_ptr<RetexSet, Closer<RetexSet, retex_set_close>>;
using Samples = std::unique_ptr<RetexSamples, Closer<RetexSamples, retex_samples_close>>;

static void must(int code, const RetexError &err)
{
    if (code != RETEX_OK)
        throw std::runtime_error(std::string(err.file) + ": " + err.message);
}

int main(int argc, char **argv) try {
    if (argc != 4)
        throw std::runtime_error("usage: outsider SET TARGET=IMAGE OUTPUT");
    RetexError err = {};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    must(retex_texture_spec_parse(&spec, "", argv[2], &err), err);
    RetexSet *read = nullptr;
    must(retex_set_read(argv[1], &read, nullptr, 0, &err), err);
    Set set(read);
    RetexSamples *filtered = nullptr;
    must(retex_sample(&filtered, set.get(), &spec, 1, 0, &err), err);
    Samples samples(filtered);
    std::unique_ptr<RetexImage, void (*)(RetexImage *)> picture(new RetexImage(), [](RetexImage *image) {
        retex_image_free(image);
        delete image;
    });
    must(retex_combine(picture.get(), set.get(), samples.get(), nullptr, nullptr, 0, &err), err);
    must(retex_image_write(picture.get(), argv[3], nullptr, 0, &err), err);
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "outsider: %s\n", error.what());
    return 2;
}
