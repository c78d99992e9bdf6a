// SPDX-License-Identifier: Apache-2.0
// The automaton of --paths and of layers of paths (src/paths): a path carries a state, every scattering event
// is a letter that leads to the next one. The host's table tells where (layout: shared/path_types.h), so that
// all expressions share a program; programs that tell no paths apart have one state, which accepts every
// path.
#ifndef CLRT_PATH_AUTOMATON_H
#define CLRT_PATH_AUTOMATON_H

#include "geometry/scene.h"

#ifndef PATH_LAYERS
#define PATH_LAYERS 0
#endif

/* The state of a program that tells no paths apart. */
#define STATE_OF_EVERY_PATH (1u | (KINDS_ALL << STATE_KINDS_SHIFT) | STATE_CONTINUES)

/* The states behind a vertex, one for each letter that its BSDF may write. */
typedef struct {
    uint next[LETTER_COUNT];
} AutomatonStep;

/* The state behind a letter, by the table. */
static inline uint automaton_table(const Scene* scene, uint state, uint letter)
{
    return scene->path_states[state & STATE_NUMBER_MASK].next[letter];
}

/* The state in which paths start. */
static inline uint automaton_start(const Scene* scene)
{
    return HAS(EFFECT_PATH_FILTER) ? automaton_table(scene, STATE_DEAD, LETTER_MATTE) : STATE_OF_EVERY_PATH;
}

/* The state behind a letter; dead too where the path has become too long to end within max_depth segments. */
static inline uint automaton_next(const Scene* scene, const RenderParams* params, uint state, uint letter,
                                  uint segment)
{
    const uint next = automaton_table(scene, state, letter);
    const uint distance = next >> STATE_DISTANCE_SHIFT;
    return segment + 1u + distance > params->max_depth ? STATE_DEAD : next;
}

/* All that may happen at the end of a segment. */
static inline AutomatonStep automaton_step(const Scene* scene, const RenderParams* params, uint state,
                                           uint segment)
{
    AutomatonStep step;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        step.next[letter] = automaton_next(scene, params, state, letter, segment);
    return step;
}

/* The states behind the ways that max_depth has closed though the expression leaves them open; dead behind
   all others. */
static inline AutomatonStep automaton_cut_step(const Scene* scene, const AutomatonStep* step, uint state)
{
    AutomatonStep cut;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        cut.next[letter] =
            step->next[letter] != STATE_DEAD ? STATE_DEAD : automaton_table(scene, state, letter);
    return cut;
}

/* The kinds of light (KIND_*) that end an accepted path in this state. */
static inline uint automaton_accepted(uint state) { return (state >> STATE_KINDS_SHIFT) & KINDS_ALL; }

/* True if a ray that leaves in this state can find anything: false after the last surface before a point
   light. */
static inline bool automaton_continues(uint state) { return (state & STATE_CONTINUES) != 0u; }

/* Letters (bits LETTER_BIT) that do not end the path. */
static inline uint automaton_open(const AutomatonStep* step)
{
    uint open = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        open |= step->next[letter] != STATE_DEAD ? LETTER_BIT(letter) : 0u;
    return open;
}

/* True if max_depth has closed a way that the expression leaves open. */
static inline bool automaton_is_cut(const Scene* scene, const AutomatonStep* step, uint state)
{
    const AutomatonStep cut = automaton_cut_step(scene, step, state);
    return automaton_open(&cut) != 0u;
}

/* Letters behind which a ray can find anything. */
static inline uint automaton_continuing(const AutomatonStep* step)
{
    uint found = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        found |= automaton_continues(step->next[letter]) ? LETTER_BIT(letter) : 0u;
    return found;
}

/* Letters behind which light of this kind ends an accepted path. */
static inline uint automaton_accepting(const AutomatonStep* step, uint kind)
{
    uint found = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        found |= (automaton_accepted(step->next[letter]) & kind) ? LETTER_BIT(letter) : 0u;
    return found;
}

/* True if after this state the picture must know whether an event was matte or glossy. */
static inline bool automaton_splits(uint state) { return (state & STATE_SPLITS) != 0u; }

#endif
