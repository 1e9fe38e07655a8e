/* The functions of the language that query objects, trace and inside. Expected values are those of
 * POV-Ray 3.7 unless a comment says otherwise. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "scene/scene.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

static char messages[16384];

static void collect(void *context, int level, const char *text)
{
    (void)context;
    (void)level;
    size_t used = strlen(messages);
    snprintf(messages + used, sizeof messages - used, "%s\n", text);
}

#define BEGIN                                                                                                          \
    "#version 3.7; global_settings{assumed_gamma 1} #declare N=<9,9,9>;\n"                                             \
    "#macro T(O,P,D) #local R=trace(O,P,D,N);"                                                                         \
    " #debug concat(vstr(3,R,\" \",0,4),\" | \",vstr(3,N,\" \",0,4),\"\\n\") #end\n"                                   \
    "#macro I(O,P) #debug concat(str(inside(O,P),0,0),\"\\n\") #end\n"                                                 \
    "sphere{0,1} light_source{5 1}\n"

static int run(const char *text, SdlOptions *options, RetexError *err)
{
    char path[] = "/tmp/test_scene_functions_XXXXXX", whole[8192];
    snprintf(whole, sizeof whole, "%s%s\n", BEGIN, text);
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, whole, strlen(whole)), (ssize_t)strlen(whole));
    close(file);
    messages[0] = 0;
    options->message = collect;
    Scene *scene = NULL;
    int code = sdl_read(&scene, path, options, &scene_builder, err);
    scene_close(&scene);
    unlink(path);
    return code;
}

/* The #debug output of the text; the sign of a zero does not matter. */
static void expect(const char *text, const char *output)
{
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    if (run(text, &options, &err))
        fail_msg("line %d column %d: %s", err.line, err.column, err.message);
    for (char *minus = strstr(messages, "-0.0000"); minus; minus = strstr(minus, "-0.0000"))
        memmove(minus, minus + 1, strlen(minus));
    assert_string_equal(messages, output);
}

static void test_trace_solids(void **state)
{
    (void)state;
    expect("T(sphere{0,1},-3*z,z) T(sphere{0,1},0,9*z) T(sphere{0,1 inverse},-3*z,z)",
           "0.0000 0.0000 -1.0000 | 0.0000 0.0000 -1.0000\n"
           "0.0000 0.0000 1.0000 | 0.0000 0.0000 1.0000\n"
           "0.0000 0.0000 -1.0000 | 0.0000 0.0000 1.0000\n");
    expect("T(plane{y,1},-3*y,y) T(plane{<1,2,3>,1 scale 2},9,<-1,-2,-2>)",
           "0.0000 1.0000 0.0000 | 0.0000 1.0000 0.0000\n"
           "4.7712 0.5424 0.5424 | 0.2673 0.5345 0.8018\n");
    expect("T(box{0,1},<.5,.5,.5>,x) T(box{0,1},<.5,.5,.5>,-y) T(box{0,1},<.5,.5,-2>,2*z) T(box{0,1},<.5,2,-2>,z)",
           "1.0000 0.5000 0.5000 | 1.0000 0.0000 0.0000\n"
           "0.5000 0.0000 0.5000 | 0.0000 -1.0000 0.0000\n"
           "0.5000 0.5000 0.0000 | 0.0000 0.0000 -1.0000\n"
           "0.0000 0.0000 0.0000 | 0.0000 0.0000 0.0000\n");
    expect("#declare O=cylinder{0,2*y,.5 open} T(O,<0,3,.2>,-y) T(O,<0,3,0>,<0,-1,.3>)"
           "#declare O=cone{0,1,2*y,.5} T(O,<0,1,-2>,z) T(O,<0,1,0>,-y)",
           "0.0000 0.0000 0.0000 | 0.0000 0.0000 0.0000\n"
           "0.0000 1.3333 0.5000 | 0.0000 0.0000 1.0000\n"
           "0.0000 1.0000 -0.7500 | 0.0000 0.2425 -0.9701\n"
           "0.0000 0.0000 0.0000 | 0.0000 -1.0000 0.0000\n");
    expect("T(torus{1,.3 rotate 30*x translate <1,2,3>},<2,2,-9>,z) T(disc{y,y,1,.3},<.5,-3,0>,y)"
           "T(disc{y,y,1,.3},3*y,-y)",
           "2.0000 2.0000 2.4422 | 0.3318 -0.7249 -0.6036\n"
           "0.5000 1.0000 0.0000 | 0.0000 1.0000 0.0000\n"
           "0.0000 0.0000 0.0000 | 0.0000 0.0000 0.0000\n");
}

static void test_trace_triangles(void **state)
{
    (void)state;
    expect("T(mesh{triangle{0,x,y}},<.2,.2,3>,-z) T(mesh{triangle{0,y,x} scale <1,1,-2>},<.2,.2,3>,-z)"
           "T(triangle{0,y,x},<.2,.2,3>,-z) T(polygon{5,0,x,x+y,y,0},<.5,.5,3>,-z)",
           "0.2000 0.2000 0.0000 | 0.0000 0.0000 -1.0000\n"
           "0.2000 0.2000 0.0000 | 0.0000 0.0000 -1.0000\n"
           "0.2000 0.2000 0.0000 | 0.0000 0.0000 1.0000\n"
           "0.5000 0.5000 0.0000 | 0.0000 0.0000 1.0000\n");
    expect("T(smooth_triangle{0,<0,.1,1>,x,<.1,0,1>,y,<0,.1,1>},<.2,.2,-3>,z)"
           "T(mesh{smooth_triangle{0,-<0,.1,1>,x,-<.1,0,1>,y,-<0,.1,1>}},<.2,.2,3>,-z)",
           "0.2000 0.2000 0.0000 | 0.0199 0.0797 0.9966\n"
           "0.2000 0.2000 0.0000 | -0.0199 -0.0797 -0.9966\n");
}

/* The nearest of many, also through a tree of them: a wavy mesh of 3200 triangles, and a grid of 1600 spheres. */
static void test_trace_many(void **state)
{
    (void)state;
    expect("#declare M=mesh{#for(i,0,39) #for(j,0,39) #local a=i*.1-2; #local b=j*.1-2;"
           "triangle{<a,a*b,b>,<a+.1,(a+.1)*b,b>,<a,a*(b+.1),b+.1>}"
           "triangle{<a+.1,(a+.1)*b,b>,<a,a*(b+.1),b+.1>,<a+.1,(a+.1)*(b+.1),b+.1>} #end #end}"
           "#declare Worst=0; #declare S=seed(1);"
           "#for(k,1,500) #declare P=<rand(S),2,rand(S)>*3.8-1.9; #declare Q=trace(M,P,-y);"
           "#declare Worst=max(Worst,abs(Q.x*Q.z-Q.y),vlength((Q-P)*<1,0,1>)); #end #debug str(Worst<.003,0,0)"
           "#declare U=union{#for(i,0,39) #for(j,0,39) sphere{<i,mod(i*j,7),j>,.25} #end #end translate -20}"
           "#declare Worst=0;"
           "#for(k,1,500) #declare i=floor(rand(S)*40); #declare j=floor(rand(S)*40);"
           "#declare Q=trace(U,<i-20,99,j-20>,-y,N);"
           "#declare Worst=max(Worst,vlength(Q-<i,mod(i*j,7)+.25,j>+20),vlength(N-y)); #end #debug str(Worst<1e-9,0,0)",
           "11\n");
}

static void test_trace_details(void **state)
{
    (void)state;
    /* an ident with transforms; array elements as object and normal; no normal at all; not from where it starts */
    expect(
        "#declare A=array[2]{x*0,x*0} #declare O=array[1]{object{sphere{0,1} scale <1,2,1> translate y}}"
        "#declare Q=trace(O[0],<0,9,0>,-y,A[1]); #debug vstr(3,Q,\" \",0,1)"
        "#debug \" \" #debug vstr(3,A[1],\" \",0,1) #debug \"\\n\" #declare Q=trace(O[0],9*x+y,-x); #debug str(Q.x,0,3)"
        "#debug \"\\n\" T(sphere{0,1},-1.00005*z,z) T(sphere{0,1},-1.001*z,z) T(sphere{0,1},-3*z,0)",
        "0.0 3.0 0.0 0.0 1.0 0.0\n1.000\n"
        "0.0000 0.0000 1.0000 | 0.0000 0.0000 1.0000\n"
        "0.0000 0.0000 -1.0000 | 0.0000 0.0000 -1.0000\n"
        "0.0000 0.0000 0.0000 | 0.0000 0.0000 0.0000\n");
    expect("#declare L=union{light_source{2*x rgb 1 looks_like{sphere{0,.5}}} sphere{0,.1}} T(L,9*x,-x)",
           "2.5000 0.0000 0.0000 | 1.0000 0.0000 0.0000\n");
    /* a budget holds */
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    options.max_steps = 20000;
    const char *costly = "#declare U=union{#for(i,1,100) plane{y,i} #end} #for(k,1,1000) #declare Q=trace(U,0,y); #end";
    assert_int_equal(run(costly, &options, &err), RETEX_ELIMIT);
}

static void test_inside(void **state)
{
    (void)state;
    expect("I(sphere{0,1},.5) I(sphere{0,1},.6) I(box{0,1},.5) I(box{0,1},2) I(plane{y,1},0) I(plane{y,1},2*y)",
           "1\n0\n1\n0\n1\n0\n");
    expect("#declare O=cone{0,1,2*y,.5 open} I(O,y) I(O,5*y) I(O,-5*y) I(O,<.7,1,0>) I(O,<.8,1,0>)", "1\n0\n0\n1\n0\n");
    expect("#declare O=torus{1,.3 rotate 30*x translate <1,2,3>} I(O,<2,2,3>) I(O,<1,2,3>)", "1\n0\n");
    expect("#declare O=disc{y,y,1,.3} I(O,<5,2,0>) I(O,0)", "0\n1\n");
    expect("#declare O=mesh{triangle{0,x,y} triangle{0,y,z} triangle{0,z,x} triangle{x,y,z} inside_vector <.3,.5,.7>}"
           "I(O,.1) I(O,1) I(object{O inverse},.1)",
           "1\n0\n0\n");
    expect("#declare O=union{sphere{0,1} sphere{x,1}}"
           "I(O,0) I(O,1.5*x) I(O,3*x) I(object{O inverse},-.5*x) I(object{O inverse},5*x)",
           "1\n1\n0\n0\n1\n");
    /* flat things have no inside; POV-Ray refuses to say */
    expect("I(triangle{0,x,y},<.2,.2,0>) I(mesh{triangle{0,x,y}},<.2,.2,-1>)", "0\n0\n");
}

/* Boxes that POV-Ray has too; where it turns a box, which grows by that, ours is tighter. */
static void test_extent(void **state)
{
    (void)state;
#define E                                                                                                              \
    "#macro E(O) #debug concat(vstr(3,min_extent(O),\" \",0,4),\" | \",vstr(3,max_extent(O),\" \",0,4),\"\\n\") #end "
    expect(E "#declare A=intersection{sphere{0,1} box{0,2}} E(A) #declare B=object{A translate <5,6,7>} E(B)",
           "0.0000 0.0000 0.0000 | 1.0000 1.0000 1.0000\n5.0000 6.0000 7.0000 | 6.0000 7.0000 8.0000\n");
    expect(
        E
        "#declare A=difference{sphere{0,1} box{0,2}} E(A) #declare B=intersection{sphere{0,1 inverse} box{-3,3}} E(B)",
        "-1.0000 -1.0000 -1.0000 | 1.0000 1.0000 1.0000\n-3.0000 -3.0000 -3.0000 | 3.0000 3.0000 3.0000\n");
    expect(E "#declare A=union{intersection{sphere{0,1} box{0,2}} translate 5*x rotate 90*z} E(A)"
             "#declare B=merge{sphere{0,1} sphere{x,1}} E(B)",
           "-1.0000 5.0000 0.0000 | 0.0000 6.0000 1.0000\n-1.0000 -1.0000 -1.0000 | 2.0000 1.0000 1.0000\n");
    expect(E "#declare A=sphere{0,1 clipped_by{box{0,2}}} E(A) #declare B=sphere{0,1 inverse} E(B)",
           "-1.0000 -1.0000 -1.0000 | 1.0000 1.0000 1.0000\n-1.0000 -1.0000 -1.0000 | 1.0000 1.0000 1.0000\n");
    expect(E "#declare A=intersection{plane{y,1} plane{-y,1} sphere{0,5}} E(A)"
             "#declare B=intersection{plane{y,1} plane{-y,1} plane{x,1} plane{-x,1} plane{z,1} plane{-z,2}} E(B)",
           "-5.0000 -1.0000 -5.0000 | 5.0000 1.0000 5.0000\n-1.0000 -1.0000 -2.0000 | 1.0000 1.0000 1.0000\n");
    expect("#macro F(O) #debug concat(str(max_extent(O).y/1e10,0,4),\"\\n\") #end F(plane{y,1})"
           "#declare A=difference{plane{y,1} box{0,2}} F(A) #declare B=intersection{plane{y,1} plane{-y,1}} F(B)",
           "1.0000\n1.0000\n1.0000\n");
    expect(E "#declare A=isosurface{function{x} contained_by{sphere{<1,2,3>,2}} scale 2} E(A)"
             "#declare B=intersection{sphere{0,1} sphere{5,1}} E(B)",
           "-2.0000 0.0000 2.0000 | 6.0000 8.0000 10.0000\n0.0000 0.0000 0.0000 | 0.0000 0.0000 0.0000\n");
#undef E
}

/* Isosurfaces in CSG answer like other shapes. */
static void test_isosurface(void **state)
{
    (void)state;
    expect("#declare A=isosurface{function{sqrt(x*x+y*y+z*z)-1} contained_by{box{-2,2}} max_gradient 1.1}"
           "#declare B=difference{box{-2,2} object{A}}"
           "T(A,-3*z,z) T(B,0,y) T(B,<0,0,-5>,z) I(A,0) I(A,<.8,.8,0>) I(B,0) I(B,<1.5,0,0>)",
           "0.0000 0.0000 -1.0000 | 0.0000 0.0000 -1.0000\n"
           "0.0000 1.0000 0.0000 | 0.0000 -1.0000 0.0000\n"
           "0.0000 0.0000 -2.0000 | 0.0000 0.0000 -1.0000\n"
           "1\n0\n0\n1\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trace_solids),  cmocka_unit_test(test_trace_triangles), cmocka_unit_test(test_trace_many),
        cmocka_unit_test(test_trace_details), cmocka_unit_test(test_inside),          cmocka_unit_test(test_extent),
        cmocka_unit_test(test_isosurface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
