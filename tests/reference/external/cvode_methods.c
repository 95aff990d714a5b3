/* SUNDIALS' CVODE, compiled with its right-hand side, on the scenes of scenes.json.

     cc -O3 -march=native cvode_methods.c -o cvode -lsundials_cvode -lsundials_nvecserial -lm    (Debian: libsundials-dev)
     ./cvode scenes.json

   `just lab accuracy` builds and runs it. One row a run on the standard output, failures kept. Contacts are located as roots, and the phase
   (flight, or touching a wall) is frozen in between. The time is the least of several runs of the motion alone; the largest E1
   is sought in the dense output of one more. The law of one restitution at every speed is left out: it is an equation to be solved at each
   evaluation. */

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

enum { FLIGHT, TOUCHING };
static const int MOST_EVENTS = 10000, MOST_EVALUATIONS = 20000000;
static const double PATIENCE = 2.0; /* s: tighter tolerances of a method that took longer are left out */

typedef struct {
    char name[64];
    double T, m1, c1, k1, P, omega, m2, k2, c2, D, C, K1, K3, lambda, restitution;
    int rigid;
} Scene;

typedef struct {
    const Scene *s;
    int phase;
    double sign; /* of the push of the wall on the structure: 1 at r = 0, -1 at r = D + C */
    long evaluations;
} Motion;

static double indentation(const Motion *m, const double *y) {
    double r = y[2] - y[0];
    return m->sign > 0 ? -r : r - m->s->D - m->s->C;
}

static int f(sunrealtype t, N_Vector at, N_Vector rates, void *data) {
    Motion *m = data;
    const Scene *s = m->s;
    const double *y = N_VGetArrayPointer(at);
    double *d = N_VGetArrayPointer(rates), push = 0.0;
    if (++m->evaluations > MOST_EVALUATIONS) return -1;
    d[0] = y[1];
    if (m->phase == TOUCHING) {
        double z = fmax(indentation(m, y), 0.0), closing = m->sign * (y[1] - y[3]);
        push = m->sign * (m->sign > 0 ? s->K1 : s->K3) * z * sqrt(z) * (1.0 + s->lambda * closing);
    }
    double on_damper = push - s->c2 * (y[3] - y[1]) - s->k2 * (y[2] - y[0] - s->D);
    d[1] = (s->P * cos(s->omega * t) - s->c1 * y[1] - s->k1 * y[0] - on_damper) / s->m1;
    d[2] = y[3];
    d[3] = on_damper / s->m2;
    return 0;
}

static int jacobian(sunrealtype t, N_Vector at, N_Vector rates, SUNMatrix j, void *data, N_Vector a, N_Vector b, N_Vector c) {
    Motion *m = data;
    const Scene *s = m->s;
    const double *y = N_VGetArrayPointer(at);
    double k = s->k2, drag = s->c2;
    (void)t, (void)rates, (void)a, (void)b, (void)c;
    m->evaluations++;
    SUNMatZero(j);
    SM_ELEMENT_D(j, 0, 1) = 1.0;
    if (m->phase == TOUCHING) {
        double z = fmax(indentation(m, y), 0.0), K = m->sign > 0 ? s->K1 : s->K3, closing = m->sign * (y[1] - y[3]);
        k += 1.5 * K * sqrt(z) * (1.0 + s->lambda * closing);
        drag += K * z * sqrt(z) * s->lambda;
    }
    SM_ELEMENT_D(j, 1, 0) = -(s->k1 + k) / s->m1;
    SM_ELEMENT_D(j, 1, 1) = -(s->c1 + drag) / s->m1;
    SM_ELEMENT_D(j, 1, 2) = k / s->m1;
    SM_ELEMENT_D(j, 1, 3) = drag / s->m1;
    SM_ELEMENT_D(j, 2, 3) = 1.0;
    SM_ELEMENT_D(j, 3, 0) = k / s->m2;
    SM_ELEMENT_D(j, 3, 1) = drag / s->m2;
    SM_ELEMENT_D(j, 3, 2) = -k / s->m2;
    SM_ELEMENT_D(j, 3, 3) = -drag / s->m2;
    return 0;
}

/* What keeps the phase going; an event is a fall through zero. */
static int gaps(sunrealtype t, N_Vector at, sunrealtype *g, void *data) {
    Motion *m = data;
    const double *y = N_VGetArrayPointer(at);
    double r = y[2] - y[0];
    (void)t;
    g[0] = m->phase == FLIGHT ? r : indentation(m, y);
    g[1] = m->phase == FLIGHT ? m->s->D + m->s->C - r : 1.0;
    return 0;
}

/* The phase after event `which`, begun a hair (1e-15 m) beyond the wall; 1 if it was a touch-down. */
static int after(Motion *m, double *y, int which) {
    const Scene *s = m->s;
    int touched = m->phase == FLIGHT;
    if (touched) m->sign = which == 0 ? 1.0 : -1.0;
    double wall = m->sign > 0 ? 0.0 : s->D + s->C, beyond = 1e-15 * m->sign;
    if (touched && s->rigid) {
        double w = y[3] - y[1];
        y[1] += (1.0 + s->restitution) * s->m2 / (s->m1 + s->m2) * w;
        y[3] = y[1] - s->restitution * w;
    } else {
        m->phase = touched ? TOUCHING : FLIGHT;
    }
    y[2] = y[0] + wall + (m->phase == TOUCHING ? -beyond : beyond);
    return touched;
}

static double energy(const Scene *s, const double *y) { return 0.5 * (s->m1 * y[1] * y[1] + s->k1 * y[0] * y[0]); }

/* E1 and its rate inside the last step, from its dense output. */
static double rate(void *solver, Motion *m, N_Vector y, N_Vector d, double t, double *e1) {
    CVodeGetDky(solver, t, 0, y);
    f(t, y, d, m);
    m->evaluations--;
    const double *at = N_VGetArrayPointer(y);
    *e1 = energy(m->s, at);
    return at[1] * (m->s->k1 * at[0] + m->s->m1 * N_VGetArrayPointer(d)[1]);
}

/* The largest E1 of the last step from `a` to `b`: where its rate falls through zero, by bisection. */
static double largest(void *solver, Motion *m, N_Vector y, N_Vector d, double a, double b) {
    enum { PIECES = 8 };
    double e1, best, before = rate(solver, m, y, d, a, &best);
    for (int i = 1; i <= PIECES; i++) {
        double low = a + (b - a) * (i - 1) / PIECES, high = i == PIECES ? b : a + (b - a) * i / PIECES;
        double next = rate(solver, m, y, d, high, &e1);
        best = fmax(best, e1);
        if (before > 0.0 && next < 0.0)
            for (int k = 0; k < 40; k++) {
                double middle = 0.5 * (low + high);
                *(rate(solver, m, y, d, middle, &e1) > 0.0 ? &low : &high) = middle;
                best = fmax(best, e1);
            }
        before = next;
    }
    return best;
}

typedef struct {
    long evaluations, impacts;
    double e1_max, y[4];
    char failure[96];
} Found;

static Found run(const Scene *s, int method, double rtol, int watched, SUNContext context) {
    Motion m = {s, FLIGHT, 1.0, 0};
    Found found = {0};
    N_Vector y = N_VNew_Serial(4, context), at = N_VNew_Serial(4, context), d = N_VNew_Serial(4, context);
    SUNMatrix matrix = SUNDenseMatrix(4, 4, context);
    SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
    double *state = N_VGetArrayPointer(y), t = 0.0;
    int directions[2] = {-1, -1}, events = 0, flag = 0;
    N_VConst(0.0, y);
    state[2] = s->D;
    void *solver = CVodeCreate(method, context);
    CVodeInit(solver, f, t, y);
    CVodeSStolerances(solver, rtol, rtol * 1e-3);
    CVodeSetUserData(solver, &m);
    CVodeSetLinearSolver(solver, linear, matrix);
    CVodeSetJacFn(solver, jacobian);
    CVodeRootInit(solver, 2, gaps);
    CVodeSetRootDirection(solver, directions);
    CVodeSetNoInactiveRootWarn(solver);
    CVodeSetStopTime(solver, s->T);
    while (t < s->T) {
        double before = t;
        flag = CVode(solver, s->T, y, &t, CV_ONE_STEP);
        if (flag < 0) {
            snprintf(found.failure, sizeof found.failure, "flag %d of CVode at t = %g s", flag, t);
            break;
        }
        if (watched) found.e1_max = fmax(found.e1_max, largest(solver, &m, at, d, before, t));
        if (flag != CV_ROOT_RETURN) continue;
        int roots[2] = {0, 0};
        CVodeGetRootInfo(solver, roots);
        found.impacts += after(&m, state, roots[0] ? 0 : 1);
        found.e1_max = fmax(found.e1_max, energy(s, state));
        if (++events > MOST_EVENTS) {
            snprintf(found.failure, sizeof found.failure, "more than %d events: stuck at t = %g s", MOST_EVENTS, t);
            break;
        }
        CVodeReInit(solver, t, y);
    }
    memcpy(found.y, state, sizeof found.y);
    found.evaluations = m.evaluations;
    CVodeFree(&solver);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(y), N_VDestroy(at), N_VDestroy(d);
    return found;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void compare(const Scene *s, SUNContext context) {
    for (int which = 0; which < 2; which++)
        for (int exponent = 3; exponent <= 12; exponent++) {
            int method = which ? CV_ADAMS : CV_BDF, runs;
            double rtol = pow(10.0, -exponent), times[100], begun = now();
            Found found = run(s, method, rtol, 1, context);
            double first = now();
            run(s, method, rtol, 0, context);
            times[0] = now() - first;
            runs = times[0] < 1e-3 ? 100 : times[0] < 0.02 ? 6 : times[0] < 0.15 ? 2 : 0;
            for (int i = 0; i < runs; i++) {
                first = now();
                run(s, method, rtol, 0, context);
                times[i] = now() - first;
            }
            qsort(times, runs, sizeof *times, ascending);
            printf("SUNDIALS %s,%s,%s,%.0e,", SUNDIALS_VERSION, which ? "Adams" : "BDF", s->name, rtol);
            if (*found.failure)
                printf(",,,,,,,,%s,\n", found.failure);
            else
                printf("%.4g,%ld,%.17g,%.17g,%.17g,%.17g,%.17g,%ld,,%.3f\n", times[0], found.evaluations, found.e1_max, found.y[0], found.y[1],
                       found.y[2], found.y[3], found.impacts, runs ? times[runs / 2] / times[0] - 1.0 : NAN);
            fflush(stdout);
            if (now() - begun > PATIENCE) break;
        }
}

/* The value of a key on a line of pretty JSON, if the line has it. */
static int number(const char *line, const char *key, double *value) {
    char name[64], text[64];
    if (sscanf(line, " \"%63[^\"]\": %63[^,\n]", name, text) != 2 || strcmp(name, key)) return 0;
    *value = strcmp(text, "true") == 0 ? 1.0 : strcmp(text, "null") == 0 || strcmp(text, "false") == 0 ? 0.0 : atof(text);
    return 1;
}

int main(int count, char **arguments) {
    FILE *file = count == 2 ? fopen(arguments[1], "r") : NULL;
    SUNContext context;
    if (!file || SUNContext_Create(0, &context)) {
        fprintf(stderr, "usage: cvode scenes.json\n");
        return 2;
    }
    char line[256];
    Scene s = {0};
    while (fgets(line, sizeof line, file)) {
        double rigid = 0.0;
        if (strchr(line, '{')) s = (Scene){0};
        sscanf(line, " \"scene\": \"%63[^\"]\"", s.name);
        struct { const char *key; double *value; } of[] = {
            {"T", &s.T}, {"m1", &s.m1}, {"c1", &s.c1}, {"k1", &s.k1}, {"P", &s.P}, {"omega", &s.omega}, {"m2", &s.m2}, {"k2", &s.k2}, {"c2", &s.c2},
            {"D", &s.D}, {"C", &s.C}, {"K1", &s.K1}, {"K3", &s.K3}, {"lambda", &s.lambda}, {"restitution", &s.restitution}};
        for (size_t i = 0; i < sizeof of / sizeof *of; i++) number(line, of[i].key, of[i].value);
        if (number(line, "rigid", &rigid)) s.rigid = rigid != 0.0;
        if (strchr(line, '}') && (s.rigid || s.restitution == 0.0)) compare(&s, context);
    }
    fclose(file);
    SUNContext_Free(&context);
    return 0;
}
