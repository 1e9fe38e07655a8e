// The same program in C++, with objects that close themselves. outsider SET EDIT OUTPUT
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include <retex/retex.h>

template <class T, void (*close)(T **)> struct Closer {
    void operator()(T *object) const { close(&object); }
};
using Set = std::unique_ptr<RetexSet, Closer<RetexSet, retex_set_close>>;
using Edit = std::unique_ptr<RetexEdit, Closer<RetexEdit, retex_edit_close>>;

static void must(int code, const RetexError &err)
{
    if (code != RETEX_OK)
        throw std::runtime_error(std::string(err.file) + ": " + err.message);
}

int main(int argc, char **argv) try {
    if (argc != 4)
        throw std::runtime_error("usage: outsider SET EDIT OUTPUT");
    RetexError err = {};
    RetexEdit *made = nullptr;
    must(retex_edit_create(&made, &err), err);
    Edit edit(made);
    must(retex_edit_parse(made, argv[2], &err), err);
    RetexSet *read = nullptr;
    must(retex_set_read(argv[1], &read, 0, &err), err);
    Set set(read);
    must(retex_sample(set.get(), retex_edit_texture(made, 0), retex_edit_count(made), 0, &err), err);
    std::unique_ptr<RetexImage, void (*)(RetexImage *)> picture(new RetexImage(), [](RetexImage *image) {
        retex_image_free(image);
        delete image;
    });
    must(retex_combine(picture.get(), set.get(), nullptr, nullptr, 0, &err), err);
    must(retex_image_write(picture.get(), argv[3], nullptr, 0, &err), err);
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "outsider: %s\n", error.what());
    return 2;
}
