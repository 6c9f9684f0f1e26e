/* The linear error model with the damping law inside (theory.md 2 and 3), as navcore/mechanization/error_model.py
 * computes it: seven states [dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U], SI and radians, integrated by RK4;
 * sensor errors and the law's correction are held over a step. Freestanding C99: no library, no allocation.
 * The moving report (app/views/requirements/moving.py) packs its arguments. */

enum { STATES = 7, MOST = 8 };

/* Coefficients of a half step, in the order of navcore.mechanization.trajectory.HALF_STEP. */
typedef struct {
    double w_e, w_n, w_u, f_e, f_n, f_u, inv_m, inv_n, tan_lat, earth_n, earth_u, v_e, v_n, v_u, up_lat, sec_lat;
    double m, n_cos;
} half_step;

/* Law of a method: what feeds the network, when it acts, and Q = 1 - H in discrete time (theory.md 3.5).
 * After these numbers follow steady, B, C and E of `order` numbers each, and dA row by row. */
typedef struct {
    double kind;       /* 0 free, 1 internal, 2 external */
    double order;      /* states of a level channel, at most MOST */
    double limit;      /* m/s: undamped while |V_r - V_c| exceeds it; below 0: no limit */
    double k1;         /* velocity feedback of gains, 1/s */
    double feeds_back; /* 1: the network has velocity feedback as its second output */
    double as_printed; /* 1: the reference's transport rate is left out */
    double ship_axes;  /* 1: the log is turned by the computed heading */
    double D, F;
} law_head;

typedef struct {
    const law_head *p;
    const double *steady, *B, *C, *E, *dA;
    double x[2][MOST];
    double d[2];
    int damped, started;
} law;

typedef struct {
    double nabla_e, nabla_n, eps_e, eps_n, eps_u, c_e, c_n;
} held;

static void rate(const half_step *c, const double *x, const held *u, double *k)
{
    const double up = x[0] * c->tan_lat * c->inv_n + c->up_lat * x[2];
    const double coriolis_up = c->w_u + c->earth_u;
    const double d_up = 2.0 * c->earth_n * x[2] + up;
    const double d_north = -2.0 * c->earth_u * x[2] + x[0] * c->inv_n;
    k[0] = c->f_n * x[6] - c->f_u * x[5] + coriolis_up * x[1] + d_up * c->v_n - d_north * c->v_u + u->nabla_e;
    k[1] = c->f_u * x[4] - c->f_e * x[6] - coriolis_up * x[0] - d_up * c->v_e - x[1] * c->inv_m * c->v_u + u->nabla_n;
    k[2] = x[1] * c->inv_m;
    k[3] = (x[0] + c->v_e * c->tan_lat * x[2]) * c->inv_n * c->sec_lat;
    k[4] = c->w_u * x[5] - c->w_n * x[6] - (x[1] + u->c_n) * c->inv_m - u->eps_e;
    k[5] = c->w_e * x[6] - c->w_u * x[4] + (x[0] + u->c_e) * c->inv_n - c->earth_u * x[2] - u->eps_n;
    k[6] = c->w_n * x[4] - c->w_e * x[5] + up + c->earth_n * x[2] - u->eps_u;
}

static void advance(double *x, double h, const half_step *c, int stride, const held *u)
{
    double k[4][STATES], y[STATES];
    rate(c, x, u, k[0]);
    for (int i = 0; i < STATES; i++) y[i] = x[i] + 0.5 * h * k[0][i];
    rate(c + stride, y, u, k[1]);
    for (int i = 0; i < STATES; i++) y[i] = x[i] + 0.5 * h * k[1][i];
    rate(c + stride, y, u, k[2]);
    for (int i = 0; i < STATES; i++) y[i] = x[i] + h * k[2][i];
    rate(c + 2 * stride, y, u, k[3]);
    for (int i = 0; i < STATES; i++) x[i] += h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]);
}

/* Feed one sample to a channel: c of its transport rate, and a that is fed back into its velocity. */
static void feed(law *l, int channel, double u, double *c, double *a)
{
    const int n = (int)l->p->order;
    double *x = l->x[channel], change[MOST];
    *c = l->p->D * u;
    *a = l->p->feeds_back != 0.0 ? l->p->F * u : l->p->k1 * u;
    for (int i = 0; i < n; i++) {
        *c += l->C[i] * x[i];
        *a += l->E[i] * x[i];
        change[i] = l->B[i] * u;
        for (int j = 0; j < n; j++) change[i] += l->dA[i * n + j] * x[j];
    }
    for (int i = 0; i < n; i++) x[i] += change[i];
}

/* One call of the law at the computed velocity v; valid: the held difference may be used. */
static void ask(law *l, const double *v, int valid, double *c, double *a)
{
    const int internal = l->p->kind == 1.0;
    const double u[2] = {internal ? -v[0] : l->d[0], internal ? -v[1] : l->d[1]};
    int wanted = internal || valid;
    if (l->p->limit >= 0.0) wanted = wanted && l->d[0] * l->d[0] + l->d[1] * l->d[1] <= l->p->limit * l->p->limit;
    if ((wanted && !l->damped) || !l->started) {
        for (int i = 0; i < (int)l->p->order; i++) {
            l->x[0][i] = internal ? l->steady[i] * u[0] : 0.0;
            l->x[1][i] = internal ? l->steady[i] * u[1] : 0.0;
        }
    }
    l->damped = wanted;
    l->started = 1;
    for (int i = 0; i < 2; i++) {
        c[i] = a[i] = 0.0;
        if (!wanted) continue;
        feed(l, i, u[i], &c[i], &a[i]);
        if (l->p->as_printed != 0.0) c[i] -= v[i] + u[i];
    }
}

static int in_range(const double *x)
{
    const double most[STATES] = {1e5, 1e5, 1e300, 1e300, 1.0, 1.0, 1.0};
    for (int i = 0; i < STATES; i++)
        if (!(x[i] < most[i] && x[i] > -most[i])) return 0;
    return 1;
}

/* Run a method; return how many rows of seven numbers it has written: phi_E, phi_N, phi_U (rad), dV_E, dV_N (m/s),
 * position error north and east (m). A row is written at every `every` steps, as long as the linear model holds.
 * coefficients: 2 steps + 1 half steps, or one that stays; motion: V_E, V_N at each step, or one that stays;
 * sensors: eps_E, eps_N, eps_U, nabla_E, nabla_N over each step; log: new epoch (0 or 1), its error E and N, valid;
 * start: the states at t = 0; packed: a law_head and what follows it. */
int run(int steps, double h, int every, const half_step *coefficients, int along, const double *motion,
        const double *sensors, const double *log, const double *start, const double *packed, double *rows);

int run(int steps, double h, int every, const half_step *coefficients, int along, const double *motion,
        const double *sensors, const double *log, const double *start, const double *packed, double *rows)
{
    law l = {.p = (const law_head *)packed, .damped = 0, .started = 0};
    const int order = (int)l.p->order;
    double x[STATES];
    int written = 0;
    l.steady = packed + sizeof(law_head) / sizeof(double);
    l.B = l.steady + order;
    l.C = l.B + order;
    l.E = l.C + order;
    l.dA = l.E + order;
    l.d[0] = l.d[1] = 0.0;
    for (int i = 0; i < STATES; i++) x[i] = start[i];
    for (int k = 0; k <= steps; k++) {
        const half_step *c = coefficients + (along ? 2 * k : 0);
        const double *v = motion + (along ? 2 * k : 0), *read = log + 4 * k, *s = sensors + 5 * k;
        double correction[2] = {0.0, 0.0}, fed_back[2] = {0.0, 0.0};
        if (!in_range(x)) break;
        if (read[0] != 0.0) {
            l.d[0] = read[1] - x[0];
            l.d[1] = read[2] - x[1];
            if (l.p->ship_axes != 0.0) {
                l.d[0] += x[6] * v[1];
                l.d[1] -= x[6] * v[0];
            }
        }
        if (l.p->kind != 0.0) {
            const double computed[2] = {v[0] + x[0], v[1] + x[1]};
            ask(&l, computed, read[3] != 0.0, correction, fed_back);
        }
        if (k % every == 0) {
            const double row[STATES] = {x[4], x[5], x[6], x[0], x[1], x[2] * c->m, x[3] * c->n_cos};
            for (int i = 0; i < STATES; i++) rows[STATES * written + i] = row[i];
            written++;
        }
        if (k == steps) break;
        const held u = {s[3] + fed_back[0], s[4] + fed_back[1], s[0], s[1], s[2], correction[0], correction[1]};
        advance(x, h, c, along ? 1 : 0, &u);
    }
    return written;
}
