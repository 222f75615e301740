// SPDX-License-Identifier: MIT
// What a whole record says is taken within its bytes and within the sonars of this build, whoever wrote it,
// and each kind is one that there is.
// Bounds: records of 8, 16, 24 and 32 sonars in a build of 16, any content
// Sources: firmware/awareness/evidence.c
// Unwind: 17
// Ci: no
// Mutant: firmware/analysis/record.c | return sonars < ARGUS_SONARS ? sonars : ARGUS_SONARS; | return sonars;
// Mutant: firmware/analysis/record.c | at[1] < ARGUS_KINDS ? at[1] : 0 | at[1]
#include "proof.h"

#include "analysis/record.c"

void proof(void) {
    const size_t sonars = nondet_size();
    ASSUME(sonars >= 1 && sonars <= SONARS_MAX / ARRAY);
    const size_t length = HEAD_BYTES + sonars * ARRAY * SONAR_BYTES + CHECK_BYTES;
    uint8_t record[length];
    ASSUME(record[4] == VERSION && record[5] == sonars * ARRAY);
    static argus_knowledge_t knowledge;
    static argus_evidence_t evidence;
    argus_record_note_t note;
    PROVE(sonars_of(record) == sonars * ARRAY && length_of(record) == length, "its length is its own");
    take(&knowledge, &evidence, &note, record);
    const size_t i = nondet_size();
    ASSUME(i < ARGUS_SONARS);
    PROVE((unsigned)knowledge.sonar[i].kind_before < ARGUS_KINDS, "a kind that there is");
    PROVE(i < sonars * ARRAY || (note.out >> i & 1u) == 0, "of none that it does not tell of");
}
