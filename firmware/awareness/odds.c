// SPDX-License-Identifier: MIT
// What a reading tells of its sonar, by how odd the readings of all the others are of late.
#include "awareness/odds.h"

#include "awareness/numbers.h"
#include "knowledge/angle.h"

// Permille of the readings: odd ones of a healthy sonar at the least; odd ones, and those that go on, of a
// faulty one. What is neither tells nothing.
typedef struct {
    int16_t usual;
    int16_t odd;
    int16_t even;
} odds_t;

static const odds_t odds[ARGUS_TESTS] = {
#define ROW(name, usual, odd, even, ...) [ARGUS_TEST_##name] = {usual, odd, even},
    ARGUS_TEST_NUMBERS(ROW)
#undef ROW
};

int32_t argus_ln(const int32_t number) {
    int32_t power = 0;
    while (number >> (power + 1) > 0) {
        power++;
    }
    return (693 * power + 693 * (number - (1 << power)) / (1 << power)) / 10;
}

static int32_t permille_but(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                            const argus_mask_t but, const argus_test_t test) {
    int32_t all = ARGUS_RATE_EARLIER * ARGUS_RATE_ONE;
    int32_t odd = all * odds[test].usual / 1000 + 1;
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool counts = (but >> i & 1u) == 0 && !argus_is_out(knowledge, i);
        all += counts ? self->of[i].rate[test].all : 0;
        odd += counts ? self->of[i].rate[test].odd : 0;
    }
    return odd * 1000 / all;
}

int32_t argus_odds_permille(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                            const int but, const argus_test_t test) {
    if (but < 0) {
        return permille_but(self, knowledge, 0, test);
    }
    const argus_mask_t sectors = argus_robot_sectors(knowledge->robot);
    const argus_mask_t others = (argus_mask_t)((sectors >> but & 1u) != 0 ? ~(unsigned)sectors : sectors);
    return permille_but(self, knowledge, (argus_mask_t)(others | 1u << but), test);
}

// Odd readings of a sonar beyond those that a healthy one has.
static int32_t excess_of(const argus_rate_t *const rate, const argus_test_t test) {
    return rate->odd - rate->all * odds[test].usual / 1000;
}

int32_t argus_odds_common_permille(const argus_evidence_t *const self,
                                   const argus_knowledge_t *const knowledge, const argus_test_t test) {
    const argus_mask_t sectors = argus_robot_sectors(knowledge->robot);
    argus_mask_t left = sectors == argus_robot_all(knowledge->robot) ? (argus_mask_t)0 : sectors;
    for (int n = 0; n < ARGUS_RATE_OUTLIERS; n++) {
        int worst = -1;
        for (int i = 0; i < knowledge->sonars; i++) {
            const bool counts = (left >> i & 1u) == 0 && !argus_is_out(knowledge, i);
            if (counts && (worst < 0 || excess_of(&self->of[i].rate[test], test) >
                                            excess_of(&self->of[worst].rate[test], test))) {
                worst = i;
            }
        }
        left |= worst >= 0 ? (argus_mask_t)(1u << worst) : 0u;
    }
    return permille_but(self, knowledge, left, test);
}

int32_t argus_odds_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                      const int sonar, const argus_test_t test, const bool odd) {
    return argus_odds_where(self, knowledge, sonar, test, odd, 0);
}

int32_t argus_odds_where(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const argus_test_t test, const bool odd,
                         const int32_t least_permille) {
    const odds_t *const o = &odds[test];
    const int32_t share = argus_odds_permille(self, knowledge, sonar, test);
    const int32_t healthy = argus_between(o->usual, o->odd * 3 / 4, argus_max(share, least_permille));
    if (odd) {
        return argus_ln(o->odd) - argus_ln(healthy);
    }
    return o->even > 0 ? argus_min(0, argus_ln(o->even) - argus_ln(1000 - healthy)) : -ARGUS_CEILING;
}

void argus_odds_note(argus_evidence_t *const self, const int sonar, const argus_test_t test, const bool odd) {
    argus_rate_t *const rate = &self->of[sonar].rate[test];
    rate->all = (uint16_t)(rate->all + ARGUS_RATE_ONE);
    rate->odd = (uint16_t)(rate->odd + (odd ? ARGUS_RATE_ONE : 0));
}

static void note_deaf(argus_rate_t *const rate, const int silent) {
    rate->all = (uint16_t)argus_min(UINT16_MAX, rate->all + (silent + 1) * ARGUS_RATE_ONE);
    rate->odd = (uint16_t)argus_min(UINT16_MAX, rate->odd + silent * ARGUS_RATE_ONE);
}

void argus_odds_note_deaf(argus_evidence_t *const self, const int sonar, const bool silent) {
    if (silent) {
        self->deaf_waits[sonar] = argus_one_more(self->deaf_waits[sonar]);
        return;
    }
    note_deaf(&self->deaf[sonar], self->deaf_waits[sonar]);
    note_deaf(&self->deaf_ring, self->deaf_waits[sonar]);
    self->deaf_waits[sonar] = 0;
}

int32_t argus_odds_deaf_permille(const argus_evidence_t *const self, const int sonar) {
    const argus_rate_t *const ring = &self->deaf_ring;
    const argus_rate_t *const own = &self->deaf[sonar];
    const int32_t usual =
        (ring->odd + ARGUS_RATE_ONE) * 1000 / (ring->all + ARGUS_DEAF_EARLIER * ARGUS_RATE_ONE);
    const int32_t earlier = ARGUS_DEAF_EARLIER_OWN * ARGUS_RATE_ONE;
    return (own->odd * 1000 + usual * earlier) / (own->all + earlier);
}

static void fade_deaf(argus_rate_t *const rate) {
    rate->all = (uint16_t)(rate->all - rate->all / ARGUS_DEAF_FADES_S);
    rate->odd = (uint16_t)(rate->odd - rate->odd / ARGUS_DEAF_FADES_S);
}

void argus_odds_fade(argus_evidence_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        for (int test = 0; test < ARGUS_TESTS; test++) {
            argus_rate_t *const rate = &self->of[i].rate[test];
            rate->all = (uint16_t)(rate->all * ARGUS_RATE_KEEPS_EIGHTHS / 8);
            rate->odd = (uint16_t)(rate->odd * ARGUS_RATE_KEEPS_EIGHTHS / 8);
        }
        fade_deaf(&self->deaf[i]);
    }
    fade_deaf(&self->deaf_ring);
}
