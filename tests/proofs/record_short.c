// SPDX-License-Identifier: MIT
// Any bytes are taken as a record, or refused, without one outside of them being read.
// Bounds: 0 to 14 bytes of any content: each head that there is
// Sources: firmware/awareness/evidence.c
// Unwind: 15
// Ci: no
// Mutant: firmware/analysis/record.c | length < V1_HEAD_BYTES || memcmp | memcmp
// Mutant: firmware/analysis/record.c | length < HEAD_BYTES || (record[10] | (record[10]
#include "proof.h"

#include "analysis/record.c"

void proof(void) {
    const size_t length = nondet_size();
    ASSUME(length <= 14);
    uint8_t record[length];
    static argus_knowledge_t knowledge;
    static argus_evidence_t evidence;
    argus_record_note_t note;
    const argus_record_fault_t fault = argus_record_decode(&knowledge, &evidence, &note, record, length);
    PROVE(fault == ARGUS_RECORD_OK || (note.robot == 0 && note.out == 0), "refused, nothing is taken");
    PROVE(fault != ARGUS_RECORD_OK, "no whole one is so short");
}
