#include "heights.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum kind { PLANE, CONE, SPHERE, CYLINDER, TORUS, WAVE, FAN, EXPRESSION } kind;

typedef struct program program;

struct heights {
    kind kind;
    double number[8];
    int numbers;
    int axis;
    double from, to, off; /* of a flat base, and what is taken off the field above it */
    program *code;        /* of an expression */
};

/* An expression as steps of a stack machine: a number, x, y, z, or what is done to the top. */
typedef enum operation {
    NUMBER,
    X,
    Y,
    Z,
    NEGATE,
    ADD,
    SUBTRACT,
    MULTIPLY,
    DIVIDE,
    POWER,
    CALL
} operation;

typedef struct step {
    operation what;
    double number;
    int function;
} step;

enum { STEPS = 400, STACK = 50 };

struct program {
    step step[STEPS];
    int count;
};

typedef struct reading {
    const char *at;
    program *out;
    int bad;
} reading;

static const char *const functions[] = {"sqrt", "sin",  "cos",  "abs", "exp", "log",   "tan",
                                        "atan", "asin", "acos", "min", "max", "hypot", "atan2"};
enum { FUNCTIONS = sizeof functions / sizeof *functions, FUNCTIONS_OF_ONE = 10 };

static void sum(reading *r);

static void emit(reading *r, step one) {
    if (r->out->count == STEPS)
        r->bad = 1;
    else
        r->out->step[r->out->count++] = one;
}

static int takes(reading *r, const char *what) {
    while (isspace((unsigned char)*r->at))
        r->at++;
    size_t n = strlen(what);
    if (strncmp(r->at, what, n) != 0)
        return 0;
    r->at += n;
    return 1;
}

static void function(reading *r, const char *name, size_t n) {
    int f = 0;
    while (f < FUNCTIONS && (strlen(functions[f]) != n || strncmp(functions[f], name, n) != 0))
        f++;
    sum(r);
    if (f >= FUNCTIONS_OF_ONE && takes(r, ","))
        sum(r);
    else if (f >= FUNCTIONS_OF_ONE)
        r->bad = 1;
    if (f == FUNCTIONS || !takes(r, ")"))
        r->bad = 1;
    emit(r, (step){CALL, 0, f});
}

static void item(reading *r) {
    if (takes(r, "(")) {
        sum(r);
        r->bad |= !takes(r, ")");
        return;
    }
    const char *name = r->at;
    while (isalpha((unsigned char)*r->at) || (r->at > name && isdigit((unsigned char)*r->at)))
        r->at++;
    size_t n = (size_t)(r->at - name);
    if (n == 0) {
        char *end;
        emit(r, (step){NUMBER, strtod(r->at, &end), 0});
        r->bad |= end == r->at;
        r->at = end;
    } else if (takes(r, "(")) {
        function(r, name, n);
    } else if (n == 1 && *name >= 'x' && *name <= 'z') {
        emit(r, (step){(operation)(X + *name - 'x'), 0, 0});
    } else {
        emit(r, (step){NUMBER, PI, 0});
        r->bad |= n != 2 || strncmp(name, "pi", 2) != 0;
    }
}

static void power(reading *r) {
    if (takes(r, "-")) {
        power(r);
        emit(r, (step){NEGATE, 0, 0});
        return;
    }
    item(r);
    if (takes(r, "^")) {
        power(r);
        emit(r, (step){POWER, 0, 0});
    }
}

static void product(reading *r) {
    power(r);
    for (int times_it; !r->bad && ((times_it = takes(r, "*")) || takes(r, "/"));) {
        power(r);
        emit(r, (step){times_it ? MULTIPLY : DIVIDE, 0, 0});
    }
}

static void sum(reading *r) {
    product(r);
    for (int adds; !r->bad && ((adds = takes(r, "+")) || takes(r, "-"));) {
        product(r);
        emit(r, (step){adds ? ADD : SUBTRACT, 0, 0});
    }
}

static int compile(program *out, const char *text) {
    reading r = {text, out, 0};
    sum(&r);
    takes(&r, "");
    return !r.bad && *r.at == 0;
}

static double called(int f, double a, double b) {
    switch (f) {
    case 0:
        return sqrt(a);
    case 1:
        return sin(a);
    case 2:
        return cos(a);
    case 3:
        return fabs(a);
    case 4:
        return exp(a);
    case 5:
        return log(a);
    case 6:
        return tan(a);
    case 7:
        return atan(a);
    case 8:
        return asin(a);
    case 9:
        return acos(a);
    case 10:
        return fmin(a, b);
    case 11:
        return fmax(a, b);
    case 12:
        return hypot(a, b);
    }
    return atan2(a, b);
}

static double combined(operation what, double a, double b) {
    switch (what) {
    case ADD:
        return a + b;
    case SUBTRACT:
        return a - b;
    case MULTIPLY:
        return a * b;
    case DIVIDE:
        return a / b;
    default:
        return pow(a, b);
    }
}

static double run(const program *code, vec p) {
    double stack[STACK + 1] = {0};
    int top = 0;
    for (int i = 0; i < code->count && top < STACK; i++) {
        const step *s = &code->step[i];
        if (s->what == NUMBER)
            stack[top++] = s->number;
        else if (s->what <= Z)
            stack[top++] = s->what == X ? p.x : s->what == Y ? p.y : p.z;
        else if (s->what == NEGATE)
            stack[top - 1] = -stack[top - 1];
        else if (s->what == CALL && s->function < FUNCTIONS_OF_ONE)
            stack[top - 1] = called(s->function, stack[top - 1], 0);
        else if (s->what == CALL)
            top--, stack[top - 1] = called(s->function, stack[top - 1], stack[top]);
        else
            top--, stack[top - 1] = combined(s->what, stack[top - 1], stack[top]);
    }
    return stack[0];
}

static int read_named(heights *h, const char *text) {
    static const struct {
        const char *name;
        kind kind;
    } known[] = {{"plane:", PLANE}, {"cone:", CONE}, {"sphere:", SPHERE}, {"cylinder:", CYLINDER},
                 {"torus:", TORUS}, {"wave:", WAVE}, {"fan:", FAN}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        size_t n = strlen(known[i].name);
        if (strncmp(text, known[i].name, n) != 0)
            continue;
        h->kind = known[i].kind;
        const char *at = text + n;
        if ((h->kind == CYLINDER || h->kind == FAN) && *at >= 'x' && *at <= 'z') {
            h->axis = *at++ - 'x';
            at += *at == ',';
        }
        for (char *end; *at && h->numbers < 8; at = *end == ',' ? end + 1 : end) {
            h->number[h->numbers++] = strtod(at, &end);
            if (end == at)
                return -1;
        }
        return 1;
    }
    return 0;
}

heights *heights_new(const char *text, const double base[3]) {
    heights *h = calloc(1, sizeof *h);
    if (!h)
        return NULL;
    *h = (heights){.from = base[0], .to = base[1], .off = base[2]};
    int found = read_named(h, text), bad = found < 0;
    if (found == 0) {
        h->kind = EXPRESSION;
        h->code = calloc(1, sizeof *h->code);
        bad = !h->code || !compile(h->code, text);
    }
    if (bad) {
        fprintf(stderr, "the field '%s' isn't understood\n", text);
        heights_free(h);
        return NULL;
    }
    return h;
}

void heights_free(heights *h) {
    if (h)
        free(h->code);
    free(h);
}

/* p's place around an axis: across it twice, along it. */
static vec around(int axis, vec p, const double *center) {
    double c[3] = {p.x, p.y, p.z};
    return (vec){c[axis == 0 ? 1 : 0] - center[0], c[axis == 2 ? 1 : 2] - center[1], c[axis]};
}

static double curved(const heights *h, vec p) {
    const double *n = h->number;
    switch (h->kind) {
    case PLANE:
        return dot(unit((vec){n[0], n[1], n[2]}), p);
    case CONE:
        return p.z * cos(n[0] * PI / 180) + hypot(p.x - n[1], p.y - n[2]) * sin(n[0] * PI / 180);
    case SPHERE:
        return length(minus(p, (vec){n[0], n[1], n[2]}));
    case CYLINDER: {
        vec q = around(h->axis, p, n);
        return hypot(q.x, q.y);
    }
    case TORUS:
        return hypot(hypot(p.x - n[1], p.y - n[2]) - n[0], p.z - n[3]);
    case WAVE: {
        double a = n[2] * PI / 180;
        return p.z + n[0] * sin(2 * PI * (p.x * cos(a) + p.y * sin(a)) / n[1]);
    }
    case FAN: {
        vec q = around(h->axis, p, n);
        return fabs(n[2]) * atan2(q.y, n[2] < 0 ? -q.x : q.x);
    }
    case EXPRESSION:
        break;
    }
    return run(h->code, p);
}

double heights_at(const heights *h, vec p) {
    if (h->to <= h->from)
        return curved(h, p);
    double t = fmin(1, fmax(0, (p.z - h->from) / (h->to - h->from))), s = t * t * (3 - 2 * t);
    return p.z + (s > 0 ? s * (curved(h, p) - h->off - p.z) : 0);
}

vec heights_gradient(const heights *h, vec p) {
    const double d = 1e-5;
    vec x = {d, 0, 0}, y = {0, d, 0}, z = {0, 0, d};
    return times((vec){heights_at(h, plus(p, x)) - heights_at(h, minus(p, x)),
                       heights_at(h, plus(p, y)) - heights_at(h, minus(p, y)),
                       heights_at(h, plus(p, z)) - heights_at(h, minus(p, z))},
                 0.5 / d);
}
