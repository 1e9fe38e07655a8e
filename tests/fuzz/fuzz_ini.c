/* POV-Ray's .ini files and switches. The first line of an input has a word for each part of a command line, as
 * `fuzz.ini[day] +KFF12`; the rest is fuzz.ini, which may include itself and part.ini. Of what is accepted, every frame
 * must have values that a scene can be told, and the output a name for each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "job/ini.h"
#include "lib_fuzz.h"

enum { WORDS = 8 };

static char folder[] = "/tmp/retex-fuzz-ini-XXXXXX"; /* of fuzz.ini and part.ini */
static pid_t owner;

static const char *path_of(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void clean(void)
{
    if (getpid() != owner)
        return;
    unlink(path_of("fuzz.ini")), unlink(path_of("part.ini"));
    rmdir(folder);
}

static void write_text(const char *name, const char *text, size_t size)
{
    FILE *file = fopen(path_of(name), "wb");
    if (!file || fwrite(text, 1, size, file) != size || fclose(file))
        abort();
}

static void begin(void)
{
    static const char part[] = "; included\nWidth=32\n[night]\nClock=0.75\nDeclare=Dark=1\n";
    static const char *const seeds[] = {
        "fuzz.ini\nInput_File_Name=room.pov\nWidth=320\nHeight=240\nInitial_Frame=1\nFinal_Frame=12\n"
        "Initial_Clock=0\nFinal_Clock=2.5\nCyclic_Animation=on\nSubset_Start_Frame=0.25\nSubset_End_Frame=0.75\n"
        "Frame_Step=2\nOutput_File_Name=out/pan.png\nOutput_File_Type=N\n",
        "fuzz.ini[day] +KFF12 +SF2 +EF3\nAntialias=on\n[day]\nClock=.5 ; noon\nDeclare=Sun=1e3\n+W64 +H48 -D +A0.3\n"
        "Library_Path=\"some where\"\n[ night ]\nQuality=9\n",
        "fuzz.ini +Ifuzz.pov +KFI3 +KFF999999999 +KI-1 +KF1e9 +KC +STP7\nInclude_Ini=part.ini[night]\npart.ini\n"
        "Pre_Frame_Command=echo %s\nStochastic_Seed=17\nWork_Threads=2\nContinue_Trace=on\n",
        "+K0.25 fuzz.ini +SC0.1 +EC0.9 +SR2 +ER7 +FE +Ofilm%s +SS3 +WT4 +C "
        "+Llib\nStart_Column=3\nEnd_Row=.5\nfuzz.ini\n"
        "Bounding=off Video_Mode='1' \"Display=off\"\nother.pov\n",
    };
    if (!mkdtemp(folder) || atexit(clean))
        abort();
    owner = getpid();
    write_text("part.ini", part, strlen(part));
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
        fuzz_seed(seeds[i], strlen(seeds[i]));
        fuzz_words(seeds[i], strlen(seeds[i]));
    }
}

/* NAME=NUMBER, finite. */
static void check_declare(const char *declare)
{
    const char *equals = strchr(declare, '=');
    char *end;
    fuzz_must(equals && animation_is_declare(declare), "a frame's value has a name of its own");
    fuzz_must(isfinite(strtod(equals + 1, &end)) && end > equals + 1 && !*end, "a frame's value is a number");
}

static void check_frame(const Animation *animation, int frame)
{
    char declares[ANIMATION_DECLARES][ANIMATION_DECLARE_SIZE];
    animation_declares(animation, frame, declares);
    for (int k = 0; k < ANIMATION_DECLARES; k++)
        check_declare(declares[k]);
}

static void check_options(const IniOptions *ini)
{
    const Animation *a = &ini->animation;
    fuzz_must(ini->step >= 1 && ini->width >= 0 && ini->height >= 0 && ini->threads >= 0, "numbers are in range");
    for (int k = 0; k < 4; k++)
        fuzz_must(isfinite(ini->window[k]) && ini->window[k] >= 0, "a window has places");
    char *name = ini_output_name(ini);
    fuzz_must(!name == !ini->output, "an output has a name");
    free(name);
    if (a->last_frame < 0 || a->last_frame < a->first_frame)
        return;
    int first, last;
    ini_frames(ini, &first, &last);
    fuzz_must(first >= 0 && last >= 0, "frames are counted from 0");
    check_frame(a, a->first_frame);
    check_frame(a, a->first_frame + (a->last_frame - a->first_frame) / 2);
    check_frame(a, a->last_frame);
}

static int run(const unsigned char *bytes, size_t size)
{
    IniOptions ini = INI_OPTIONS_INIT;
    RetexError err = {0};
    char *text = strdup((const char *)bytes), *rest = text ? strchr(text, '\n') : NULL, *word = text;
    int code = rest ? 0 : -1;
    ini.safe = (int)(size & 1);
    if (rest) {
        *rest = '\0';
        write_text("fuzz.ini", (const char *)bytes + (rest + 1 - text), size - (size_t)(rest + 1 - text));
    }
    for (int k = 0; k < WORDS && word && !code; k++) {
        char *next = strchr(word, ' ');
        if (next)
            *next++ = '\0';
        if (*word == '+')
            code = ini_switch(&ini, word, &err);
        else if (ini_is_file(word))
            code = ini_read(&ini, path_of(word), &err);
        fuzz_must(!code == !err.message[0], "an error has a message");
        fuzz_must(!strchr(err.message, '\n'), "a message is one line");
        word = next;
    }
    if (!code)
        check_options(&ini);
    ini_close(&ini);
    free(text);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"ini", 1, begin, run};
    return fuzz_main(&driver, argc, argv);
}
