/* Trees of user functions, between function_user.c, which parses them, and function_compile.c. */
#ifndef RENDERER_SDL_LANG_FUNCTION_H
#define RENDERER_SDL_LANG_FUNCTION_H

#include "function/function.h"
#include "sdl/lang/internal.h"

enum { MAX_VARIABLES = 64, MAX_HEIGHT = 2000 };

typedef enum NodeOp {
    OP_NUMBER,
    OP_VARIABLE,
    OP_APPLY, /* of a FunctionOp, left to right if it has more than two arguments */
    OP_CHOOSE,
    OP_CALL,
    OP_SUM,
    OP_PRODUCT
} NodeOp;

typedef struct Node {
    NodeOp op;
    int id; /* index of the variable, or a FunctionOp */
    int count;
    int height;  /* of the subtree, with called functions: limits the recursion */
    double size; /* nodes of the subtree */
    double number;
    struct Node **args;
    const Function *function;
    const char *component; /* component of a function that returns a vector */
} Node;

typedef enum FunctionKind { FUNCTION_KIND_TREE, FUNCTION_KIND_INTERNAL, FUNCTION_KIND_FOREIGN } FunctionKind;

struct Function {
    FunctionKind kind;
    int nparameters;
    const char *parameters[MAX_PARAMETERS];
    Node *body;
    const FunctionProgram *program; /* of the body */
    int internal;
    FunctionForeign foreign;
    const char *unsupported; /* what of it, or of a function that it calls, is not supported, or NULL */
};

/* function_compile.c */
const FunctionProgram *function_compile(Sdl *sdl, const Node *body, int nargs);

#endif
