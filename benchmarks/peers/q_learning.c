/* The work of lifelore.core.q_learning.learn, step for step and draw for draw: ties, visits, curves, outcomes,
   reward classes and both random streams. Built without contraction it gives the same bits. */
#include <stdint.h>

enum { TERMINAL = 1, COLLISION = 2 };

typedef struct {
    int64_t n_states, n_actions, n_outcomes, n_starts, n_classes, n_episodes, max_steps;
    double discount;
    const int32_t *next_state;
    const double *reward;
    const uint8_t *event;
    const double *outcome_cum;
    const int32_t *starts;
    const int32_t *q_row, *context_row;
    const uint8_t *reward_class;
    const double *explore_cum, *tie_weight, *epsilon, *alpha;
    double *q;
    int64_t *visits;
    uint64_t *world, *own;
    double *returns, *rewards;
    int64_t *steps, *collisions;
    uint8_t *reached;
} work;

static inline double next_uniform(uint64_t *state) {
    uint64_t s0 = state[0], s1 = state[1], total = s0 + s1;
    s1 ^= s0;
    state[0] = ((s0 << 24) | (s0 >> 40)) ^ s1 ^ (s1 << 16);
    state[1] = (s1 << 37) | (s1 >> 27);
    return (double)(total >> 11) * (1.0 / 9007199254740992.0);
}

static inline int64_t choose(const double *q, int64_t n, const double *cum, const double *ties, double epsilon,
                             uint64_t *own) {
    if (epsilon > 0.0 && next_uniform(own) < epsilon) {
        double u = next_uniform(own);
        int64_t a = 0;
        while (u >= cum[a]) a++;
        return a;
    }
    double best_value = q[0];
    int64_t best = 0, tied = 1;
    for (int64_t a = 1; a < n; a++) {
        if (q[a] > best_value) { best = a; best_value = q[a]; tied = 1; }
        else if (q[a] == best_value) tied++;
    }
    if (tied == 1) return best;
    double total = 0.0;
    for (int64_t a = best; a < n; a++) if (q[a] == best_value) total += ties[a];
    double left = next_uniform(own) * total;
    int64_t chosen = best;
    for (int64_t a = best; a < n; a++) {
        if (q[a] != best_value) continue;
        chosen = a;
        left -= ties[a];
        if (left < 0.0) break;
    }
    return chosen;
}

int64_t learn(const work *job) {
    const work w = *job;
    uint64_t world[2] = {w.world[0], w.world[1]}, own[2] = {w.own[0], w.own[1]};
    int64_t done = 0;
    for (int64_t episode = 0; episode < w.n_episodes; episode++) {
        int64_t state = w.starts[(int64_t)(next_uniform(world) * (double)w.n_starts)];
        int64_t step = 0, reward_class = 0;
        double ret = 0.0, discount = 1.0;
        uint8_t event = 0;
        while (!(event & TERMINAL) && step < w.max_steps) {
            int64_t row = w.q_row[state] * w.n_actions;
            int64_t context = w.context_row[state * w.n_classes + reward_class] * w.n_actions;
            int64_t a = choose(w.q + row, w.n_actions, w.explore_cum + context, w.tie_weight + context,
                               w.epsilon[episode], own);
            int64_t k = 0;
            if (w.n_outcomes > 1) {
                double u = next_uniform(world);
                while (u >= w.outcome_cum[k]) k++;
            }
            int64_t i = (state * w.n_actions + a) * w.n_outcomes + k;
            int64_t following = w.next_state[i];
            double reward = w.reward[i], target = reward;
            event = w.event[i];
            if (!(event & TERMINAL)) {
                const double *next = w.q + w.q_row[following] * w.n_actions;
                double best = next[0];
                for (int64_t b = 1; b < w.n_actions; b++) if (next[b] > best) best = next[b];
                target += w.discount * best;
            }
            w.q[row + a] += w.alpha[episode] * (target - w.q[row + a]);
            w.visits[row + a]++;
            ret += discount * reward;
            discount *= w.discount;
            w.rewards[episode] += reward;
            if (event & COLLISION) w.collisions[episode]++;
            reward_class = w.reward_class[i];
            state = following;
            step++;
        }
        w.returns[episode] = ret;
        w.steps[episode] = step;
        w.reached[episode] = (event & TERMINAL) > 0;
        done += step;
    }
    w.world[0] = world[0]; w.world[1] = world[1];
    w.own[0] = own[0]; w.own[1] = own[1];
    return done;
}
