/* The language core. The output of #debug is compared with that of POV-Ray 3.7.0.10 for the same text, and error
 * messages with expected text. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

static char folder[64];

typedef struct Output {
    char text[8192];
    size_t length;
} Output;

static void message(void *context, int level, const char *text)
{
    Output *output = context;
    (void)level;
    int n = snprintf(output->text + output->length, sizeof output->text - output->length, "%s%s",
                     output->length ? "\n" : "", text);
    if (n > 0 && output->length + (size_t)n < sizeof output->text)
        output->length += (size_t)n;
}

static void write_file(const char *name, const void *bytes, size_t size)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Parse text as the scene NAME; the code, what it wrote and the error with the folder taken off. */
static int parse(const char *name, const char *text, SdlOptions options, Output *output, RetexError *err)
{
    char path[128];
    Scene *scene = NULL;
    memset(output, 0, sizeof *output);
    memset(err, 0, sizeof *err);
    write_file(name, text, strlen(text));
    snprintf(path, sizeof path, "%s/%s", folder, name);
    options.message = message;
    options.message_context = output;
    int code = sdl_read(&scene, path, &options, &scene_builder, err);
    assert_int_equal(code, err->code);
    if (code)
        assert_null(scene);
    else
        scene_close(&scene);
    return code;
}

static const SdlOptions defaults = SDL_OPTIONS_INIT;

static void check(const char *text, const char *expected)
{
    Output output;
    RetexError err;
    int code = parse("scene.pov", text, defaults, &output, &err);
    if (code)
        fail_msg("%d:%d: %s\nin: %s", err.line, err.column, err.message, text);
    if (strcmp(output.text, expected) != 0)
        fail_msg("wrote `%s`, not `%s`\nin: %s", output.text, expected, text);
}

static void check_error(const char *text, int code, int line, int column, const char *expected)
{
    Output output;
    RetexError err;
    assert_int_equal(parse("scene.pov", text, defaults, &output, &err), code);
    if (strcmp(err.message, expected) != 0 || err.line != line || err.column != column)
        fail_msg("%d:%d: %s\ninstead of %d:%d: %s\nin: %s", err.line, err.column, err.message, line, column, expected,
                 text);
}

#define V "#version 3.7;\n"

/* Each line was run through POV-Ray. */
static void test_expressions(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"str(2-3-4,0,0)", "-5"},
        {"str(2/2/2,0,3)", "0.500"},
        {"str(-2*-3,0,0)", "6"},
        {"str((1|0&0),0,0)", "0"},
        {"str((1<2<3),0,0)", "1"},
        {"str((2 > 1 ? 3 : 4),0,0)", "3"},
        {"str(1/3,0,-1)", "0.333333"},
        {"str(-5.5,10,2)", "     -5.50"},
        {"str(5,-10,1)", "00000005.0"},
        {"str(int(-2.5),0,0)", "-2"},
        {"str(mod(-7,3),0,0)", "-1"},
        {"str(div(-7,2),0,0)", "-3"},
        {"str(1.5e-3,0,5)", "0.00150"},
        {"str(max(1,2,3),0,0)", "3"},
        {"str(select(0,1,2,3),0,0)", "2"},
        {"str(bitwise_and(6,3,2),0,0)", "2"},
        {"str(bitwise_xor(6,3),0,0)", "5"},
        {"str(<1,2,3>.y,0,2)", "2.00"},
        {"str((x+2*y).y,0,0)", "2"},
        {"str(vdot(<1,2,3>,<1,1,1>),0,2)", "6.00"},
        {"vstr(3,<1,2>+<1,2,3>,\",\",0,3)", "2.000,4.000,3.000"},
        {"vstr(3,<1,2,3>*<2,3,4>/2,\",\",0,1)", "1.0,3.0,6.0"},
        {"vstr(3,!<1,0,3>,\",\",0,0)", "0,1,0"},
        {"vstr(3,vaxis_rotate(x,y,90),\",\",0,2)", "0.00,0.00,-1.00"},
        {"concat(substr(\"hello\",2,3),strupr(\"abc\"),strlwr(\"ABC\"),chr(65))", "ellABCabcA"},
        {"concat(str(asc(\"B\"),0,0),str(strcmp(\"a\",\"b\"),0,0),str(val(\"2.5e1\"),0,1))", "66-125.0"},
        {"\"a\\tb\\\"c\\\\ \\u0041\"", "a\tb\"c\\ A"},
        {"datetime(1.5)", "2000-01-02 12:00:00Z"},
        {"concat(\"a\",#if(1) \"b\" #else \"c\" #end)", "ab"},
    };
    char text[256];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(text, sizeof text, V "#debug %s", cases[i][0]);
        check(text, cases[i][1]);
    }
}

static void test_colors(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"rgb <1,0,0>*0.5 + 0.1", "0.600,0.100,0.100,0.000,0.000"},
        {"rgbt 0.5 * 2", "1.000,1.000,1.000,0.000,1.000"},
        {"rgbf 0.5", "0.500,0.500,0.500,0.500,0.000"},
        {"color red 0.5 filter 0.3", "0.500,0.000,0.000,0.300,0.000"},
        {"color C filter 0.3", "1.000,1.000,0.000,0.300,0.000"},
        {"rgb 2*C", "2.000,2.000,0.000,0.000,0.000"},
        {"C*0.5 + 0.1", "0.600,0.600,0.100,0.100,0.100"},
        {"rgbt <1,2,3,4>", "1.000,2.000,3.000,0.000,4.000"},
        {"color 0.5", "0.500,0.500,0.500,0.500,0.500"},
        {"srgb 0.5", "0.214,0.214,0.214,0.000,0.000"},
    };
    char text[256];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(text, sizeof text, V "#declare C = rgb <1,1,0>; #declare D = %s; #debug vstr(5,D,\",\",0,3)",
                 cases[i][0]);
        check(text, cases[i][1]);
    }
}

static void test_control(void **state)
{
    (void)state;
    check(V "#switch (2) #case (1) #debug \"1\" #case (2) #debug \"2\" #case (3) #debug \"3\" #else #debug \"e\" #end",
          "23e");
    check(V "#switch (2.5) #range (1,3) #debug \"r\" #break #else #debug \"e\" #end", "r");
    check(V "#for (I,0,3) #if (I=2) #break #end #debug str(I,0,0) #end #debug str(I,0,0)", "012");
    check(V "#for (I,3,0,-1) #debug str(I,0,0) #end #debug str(I,0,0)", "3210-1");
    check(V "#for (I,0,1,.1) #debug str(I,0,1) #end", "0.00.10.20.30.40.50.60.70.80.91.0");
    check(V "#for (J,0,2) #declare J=J+1; #debug str(J,0,0) #end", "13");
    check(V "#declare I = 0; #while (I < 3) #declare I = I + 1; #debug str(I,0,0) #end", "123");
    check(V "#while (1) #if (1) #break #end #end #debug \"x\"", "x");
    check(V "#if (0) #debug \"a\" #elseif (1) #debug \"b\" #else #debug \"c\" #end", "b");
    check(V "#if (0) $ % \\ } #macro X( #end #end #debug \"ok\"", "ok");
    check(V "#ifdef (Retex) #debug str(Retex,0,0) #end #ifndef (Nothing) #debug \"n\" #end", "1n");
    check(V "/* a /* nested */ comment */ #debug \"ok\" // no newline", "ok");
    check("#debug str(version,0,2)\n#version 3.7;#version unofficial megapov 1.2;#debug str(version,0,1)", "3.623.7");
}

static void test_names(void **state)
{
    (void)state;
    check(V "#macro In() #debug str(L,0,0) #end #macro Out() #local L = 7; In() #end Out()", "7");
    check(V "#local A = 1; #macro M() #local A = 2; N() #end #macro N() #debug str(A,0,0) #declare A = 5; #end M()"
            "#debug str(A,0,0)",
          "21");
    check(
        V
        "#macro M(A) #local A = A*2; A #end #declare Q=3; #declare W = M(Q)+M(Q); #debug concat(str(W,0,0),str(Q,0,0))",
        "1812");
    check(V "#macro M(A) #declare A = 7; #end #declare B = <1,2,3>; M(B.x) #debug vstr(3,B,\",\",0,0) M(B) #debug "
            "str(B,0,0)",
          "1,2,37");
    check(V "#declare T = array[2]{1,2} #macro M(R) #local R = 5; #end M(T[1]) #debug str(T[1],0,0)", "5");
    check(V "#declare A = array[2][2]{{1,2},{3,4}} #declare B = A; #declare B[1][0] = 9; #debug str(A[1][0],0,0)", "3");
    check(V "#declare A = array[2.7]{1,2} #debug concat(str(dimension_size(A,1),0,0),str(A[1.9],0,0))", "22");
    check(V "#macro A() #debug \"in\" #break #debug \"no\" #end A() #debug \"out\"", "inout");
    check(V "#macro A(X Y) X+Y #end #debug str(A(1,2)*3,0,0)", "7");
    /* Without semicolons any directive ends a value. The results are those of POV-Ray 3.7. */
    check("#version 3.1 #declare X = 0\n#while (X < 3)\n#declare X = X + 1\n#end #debug str(X,0,0)", "3");
    check("#version 3.1 #declare X = 0\n#if (X < 3) #declare X = X+7 #end #debug str(X,0,0)", "7");
    check("#version 3.1 #declare X = 1 #declare X = 0 #if (X < 1) #declare X=3 #end #debug str(X,0,0)", "3");
    check("#version 3.1 #declare X = 1+ #if(1) 7 #end #debug str(X,0,0)", "8");
    check("#version 3.1 #macro M() #if(1) 4 #end #end #declare X = 3*M() #debug str(X,0,0)", "12");
    check(V "#declare A = 1; #undef A #ifdef(A) #debug \"y\" #else #debug \"n\" #end", "n");
    check(V "#declare F = seed(5); #debug concat(str(rand(F),0,8),\" \",str(rand(F),0,8))", "0.10995288 0.56935125");
}

static void test_functions(void **state)
{
    (void)state;
    check(V "#declare f = function(a){a*2} #debug str(f(3),0,0)", "6");
    check(V "#declare f = function{x+y*2} #debug str(f(3,1,0),0,0)", "5");
    check(V "#declare f = function{sum(i,1,4,i*x)+prod(i,1,3,i)} #debug str(f(2,0,0),0,2)", "26.00");
    check(V "#declare f = function(a){select(a>2,1,2,3)} #debug str(f(3),0,0)", "3");
    check(V
          "#declare S = spline{natural_spline 0,<0,0,0> 1,<1,2,3> 2,<0,0,1> 3,<1,1,1>} #debug vstr(3,S(1.2),\",\",0,6)",
          "0.864000,1.760000,2.856000");
    check(V "#declare S = spline{cubic_spline 0,<0,0,0> 1,<1,2,3> 2,<0,0,1> 3,<1,1,1>} #debug vstr(3,S(1.2),\",\",0,6)",
          "0.896000,1.808000,2.888000");
    check(
        V
        "#declare S = spline{quadratic_spline 0,<0,0,0> 1,<1,2,3> 2,<0,0,1> 3,<1,1,1>} #debug vstr(3,S(2.2),\",\",0,2)",
        "0.04,-0.04,0.84");
    /* POV-Ray 3.7's values: the parabola of a segment goes through the point before it too */
    check(V "#declare S = spline{quadratic_spline 0,1 1,3 2.5,-2 3,4 5,0.5}"
            "#for(I,0,3) #debug str(S(0.25+I).x,0,5) #debug \" \" #end",
          "1.90000 2.83333 -0.50000 5.96875 ");
}

static void test_files(void **state)
{
    (void)state;
    static const char inc[] = "#local L = 4;\r\n#declare Made = L;\r\n#macro Twice(X)\r\n (X*2) // \xe4\xff\r\n#end";
    write_file("part.inc", inc, sizeof inc - 1);
    check(V "#include \"part.inc\" #debug concat(str(Twice(Made),0,0), #ifdef(L) \"y\" #else \"n\" #end)", "8n");
    check(V "#fopen F \"t.tmp\" write #write(F, 1/3, \",\", <1,2,3>, \",\\\"s\\\"\") #fclose F"
            "#fopen F \"t.tmp\" read #read(F, A, B, C) #debug concat(str(A,0,4), vstr(3,B,\",\",0,0), C)"
            "#ifdef(F) #debug \"open\" #end",
          "0.33331,2,3s");
    check(V "#fopen F \"b.tmp\" write #write(F, uint16be 12594, \",\", sint16le 12594, \",\", uint8 <55,56>) #fclose F"
            "#fopen F \"b.tmp\" read #read(F, A, B, C) #debug concat(str(A,0,0), \" \", str(B,0,0), \" \", str(C,0,0))",
          "12 21 78");
    check(V "#macro Parse(S) #fopen F \"p.tmp\" write #write(F,S) #fclose F #include \"p.tmp\" #end"
            "#declare A = Parse(\"1+2*3\"); #debug str(A,0,0)",
          "7");
    check(V "#debug concat(str(file_exists(\"part.inc\"),0,0),str(file_exists(\"../../etc/passwd\"),0,0),"
            "str(file_exists(\"/etc/passwd\"),0,0))",
          "100");
    /* Nothing was written where the scene lies. */
    char path[128];
    snprintf(path, sizeof path, "%s/t.tmp", folder);
    assert_int_not_equal(access(path, F_OK), 0);
}

static void test_errors(void **state)
{
    (void)state;
    check_error(V "#declare Floor = 1;\n#declare Y = Flor + 1;", RETEX_EPARSE, 3, 14,
                "expected a value, found `Flor`, which is not declared; is `Floor` meant?");
    check_error(V "#declare A = 3 > 2;", RETEX_EPARSE, 2, 16,
                "expected `;` after the value of a declaration, found `>`");
    check_error(V "#declare floor = 1;", RETEX_EPARSE, 2, 10, "`floor` is a keyword and cannot be declared");
    check_error(V "#declare A = array[3]; #declare B = A[3];", RETEX_EPARSE, 2, 40,
                "index 3 is outside of an array of 3 elements");
    check_error(V "#declare A = <1,2,3>.x.y.q;", RETEX_EPARSE, 2, 26,
                "expected a component such as x or red after the `.`, found `q`");
    check_error(V "#declare C = rgb 1; #declare A = sin(C);", RETEX_EPARSE, 2, 39, "expected a float, found a color");
    check_error(V "#declare C = rgb 1; #declare A = sin(<1,2,3> + C);", RETEX_EPARSE, 2, 49,
                "expected a float, found a color");
    check_error(V "#declare C = rgb 1; #declare A = sin(C.red * <1,2,3>);", RETEX_EPARSE, 2, 53,
                "expected a float, found a vector");
    check_error(V "#macro M(A) #end M(1,2)", RETEX_EPARSE, 2, 21, "the macro `M` has only 1 parameters");
    check_error(V "#macro M(A) #end M()", RETEX_EPARSE, 2, 20, "the macro `M` has 1 parameters, 0 given");
    check_error(V "#if (1) #debug \"x\"", RETEX_EPARSE, 2, 1, "a directive without its #end");
    check_error(V "\n #end", RETEX_EPARSE, 3, 2, "a directive without the one it belongs to");
    check_error(V "#error \"stop here\\n\"", RETEX_EPARSE, 2, 8, "stop here");
    check_error(V "#delcare A = 1;", RETEX_EPARSE, 2, 1, "there is no directive `#delcare`; is `#declare` meant?");
    check_error(V "#debug \"unended", RETEX_EPARSE, 2, 8, "a string without its closing quote");
    check_error(V "/* unended", RETEX_EPARSE, 2, 1, "a comment /* without its end */");
    check_error(V "#include \"nowhere.inc\"", RETEX_EPARSE, 2, 10,
                "cannot find the file `nowhere.inc` in the scene's folder or the include path");
    check_error(V "#include \"/etc/passwd\"", RETEX_EPARSE, 2, 10,
                "the file `/etc/passwd` is outside the folders that may be read: the current one, the scene's, those "
                "of -I, POV-Ray's; name its folder with -I");
    check_error(V "#break", RETEX_EPARSE, 2, 1, "#break outside of a loop, #switch or #macro");
}

static void test_limits(void **state)
{
    (void)state;
    Output output;
    RetexError err;
    SdlOptions options = SDL_OPTIONS_INIT;
    options.max_steps = 100000;
    assert_int_equal(parse("a.pov", "#while(1) #end", options, &output, &err), RETEX_ELIMIT);
    assert_int_equal(
        parse("a.pov", V "#declare f = function{sum(i,0,1e9,i)} #declare A = f(0,0,0);", options, &output, &err),
        RETEX_ELIMIT);
    assert_int_equal(parse("a.pov", "#macro M() M() #end M()", options, &output, &err), RETEX_ELIMIT);
    write_file("self.inc", "#include \"self.inc\"", 19);
    assert_int_equal(parse("a.pov", "#include \"self.inc\"", options, &output, &err), RETEX_ELIMIT);
    assert_int_equal(
        parse("a.pov", V "#declare S = \"x\"; #while(1) #declare S = concat(S,S); #end", options, &output, &err),
        RETEX_ELIMIT);
    options.max_memory = 4 << 20;
    assert_int_equal(parse("a.pov", V "#declare A = array[1000][1000];", options, &output, &err), RETEX_ELIMIT);
    /* Deep nesting of everything that recurses. */
    char *deep = malloc(200001);
    for (int kind = 0; kind < 4; kind++) {
        static const char *const unit[] = {"(", "-", "<", "#declare A ="};
        size_t length = 0, size = strlen(unit[kind]);
        while (length + size < 60000)
            memcpy(deep + length, unit[kind], size), length += size;
        deep[length] = 0;
        char *text = malloc(length + 64);
        sprintf(text, "#declare A = %s", deep);
        assert_int_not_equal(parse("a.pov", text, defaults, &output, &err), 0);
        free(text);
    }
    free(deep);
}

static void test_options(void **state)
{
    (void)state;
    Output output;
    RetexError err;
    SdlOptions options = SDL_OPTIONS_INIT;
    const char *const declares[] = {"Size=2.5", "Name=\"oak\"", "clock=0.25"};
    options.declares = declares;
    options.ndeclares = 3;
    options.width = 320;
    options.height = 200;
    assert_int_equal(parse("a.pov",
                           V "#debug concat(str(Size,0,1),Name,str(clock,0,2),str(image_width/image_height,0,1))",
                           options, &output, &err),
                     0);
    assert_string_equal(output.text, "2.5oak0.251.6");
    const char *const keyword[] = {"sphere=1"};
    options.declares = keyword;
    options.ndeclares = 1;
    assert_int_equal(parse("a.pov", V, options, &output, &err), RETEX_EINVAL);
    options.ndeclares = 0;
    const char *used = V "#declare F = function { internal(77) } #debug str(F(0,0,0)+F(0,0,0),0,0)";
    assert_int_equal(parse("a.pov", used, options, &output, &err), 0);
    const char *line = strchr(output.text, ':'); /* once, with file and line */
    assert_non_null(line);
    assert_string_equal(line, ":2: warning: `internal(77)` is not supported yet: it gives 0\n0");
    options.strict = 1;
    assert_int_equal(parse("a.pov", used, options, &output, &err), RETEX_EUNSUPPORTED);
    Scene *scene = (Scene *)1;
    assert_int_equal(sdl_read(&scene, "/nowhere/scene.pov", NULL, &scene_builder, &err), RETEX_EIO);
    assert_null(scene);
}

/* The standard includes that are nothing but declarations. */
static void test_standard_includes(void **state)
{
    (void)state;
    static const char *const names[] = {"consts",  "colors",  "functions", "math",     "transforms", "shapes",
                                        "rand",    "strings", "arrays",    "textures", "woods",      "metals",
                                        "glass",   "stones",  "golds",     "skies",    "finish",     "stones1",
                                        "stones2", "debug",   "stars",     "shapes2"};
    if (access("/usr/share/povray-3.7/include/colors.inc", R_OK) != 0)
        skip();
    char text[128];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        Output output;
        RetexError err;
        snprintf(text, sizeof text, V "#include \"colors.inc\" #include \"shapes.inc\" #include \"%s.inc\"", names[i]);
        if (parse("scene.pov", text, defaults, &output, &err))
            fail_msg("%s.inc: %s:%d:%d: %s", names[i], err.file, err.line, err.column, err.message);
    }
    check(V "#include \"math.inc\" #debug vstr(3,VPerp_To_Vector(<1,2,3>),\",\",0,6)", "0.000000,0.832050,-0.554700");
    check(V "#include \"rand.inc\" #declare R=seed(3); #for(I,1,30) #local N=rand(R); #end #debug "
            "str(Rand_Gauss(0,1,R),0,6)",
          "-0.150835");
}

/* Bytes of no meaning at all and scenes cut anywhere: an error or not, but never more. */
static void test_rubbish(void **state)
{
    (void)state;
    static const char seed[] = V
        "#declare A = array[2][2]{{1,2},{3,<1,2,3>}} #macro M(X,Y) #if (X>Y) M(X-1,Y) #else X #end #end\n"
        "#for (I,0,3) #switch(I) #case(1) #debug concat(str(M(I,1),0,0),\"a\\n\") #break #range(2,3) #else #end #end\n"
        "#declare f = function(a,b){sum(i,0,3,i*a)+b} #declare C = color rgbft <f(1,2),.5,0,0,.1>*2;\n"
        "#fopen F \"x.tmp\" write #write(F,1,\",\",<1,2>) #fclose F #fopen F \"x.tmp\" read #read(F,P,Q)\n"
        "/* c */ #while (I < 9) #declare I = I + 1; #end #undef P #warning \"w\" #debug vstr(3,C*A[1][1],\",\",2,2)\n";
    uint32_t random = 1;
    char text[sizeof seed + 8];
    SdlOptions options = SDL_OPTIONS_INIT;
    options.max_steps = 20000;
    options.max_memory = 32 << 20;
    for (int round = 0; round < 1500; round++) {
        Output output;
        RetexError err;
        memcpy(text, seed, sizeof seed);
        if (round < 400)
            text[(size_t)round * sizeof seed / 400] = 0;
        else
            for (int i = 0; i < 3; i++) {
                random = random * 1664525u + 1013904223u;
                char c = (char)(random >> 8);
                text[(random >> 16) % (sizeof seed - 1)] = c ? c : '{';
            }
        parse("scene.pov", text, options, &output, &err);
    }
}

static void *parse_many(void *context)
{
    const char *name = context;
    for (int i = 0; i < 20; i++) {
        Output output;
        RetexError err;
        char text[128];
        snprintf(text, sizeof text, V "#declare N = 0; #for (I,1,1000) #declare N = N + I; #end #debug str(N,0,0)");
        if (parse(name, text, defaults, &output, &err) || strcmp(output.text, "500500") != 0)
            return context;
    }
    return NULL;
}

static void test_two_at_once(void **state)
{
    (void)state;
    pthread_t threads[2];
    char names[2][8] = {"t1.pov", "t2.pov"};
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, parse_many, names[i]), 0);
    for (int i = 0; i < 2; i++) {
        void *failed = NULL;
        pthread_join(threads[i], &failed);
        assert_null(failed);
    }
}

int main(void)
{
    snprintf(folder, sizeof folder, "/tmp/retex-test-sdl-XXXXXX");
    if (!mkdtemp(folder))
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_expressions), cmocka_unit_test(test_colors),
        cmocka_unit_test(test_control),     cmocka_unit_test(test_names),
        cmocka_unit_test(test_functions),   cmocka_unit_test(test_files),
        cmocka_unit_test(test_errors),      cmocka_unit_test(test_limits),
        cmocka_unit_test(test_options),     cmocka_unit_test(test_standard_includes),
        cmocka_unit_test(test_rubbish),     cmocka_unit_test(test_two_at_once),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) != 0 || failed;
}
