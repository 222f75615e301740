// SPDX-License-Identifier: MIT
// Every number of awareness/ that was set by hand, a row each. docs/evidence.md shows the table.
#ifndef ARGUS_NUMBERS_H
#define ARGUS_NUMBERS_H

// Name; value; unit (cnat: hundredths of a nat, cdeg: of a degree); where it is from: measured (the
// experiments log has the trial), reasoned, or the size of a memory; what it is; what came of a trial without
// it, or with another value. A row that begins with "..." goes on from the one before.
// clang-format off

// Sizes: how much is remembered
#define ARGUS_SIZES_TABLE(X) \
    X(PINGS, 32, "pings", measured, "that are remembered of each sonar: some 20 s in motion, longer at rest", "16 lose 2 of 314 faults") \
    X(PING_SECTORS, 32, "sectors", size, "of the bearings, in which the log of pings is searched", "16: 393,000 instructions a SIP in the drive with most faults instead of 351,000") \
    X(PINGS_AGE_MS, 40000, "ms", reasoned, "age at which a ping is dropped: what stands still stays where it was seen", "not ablated") \
    X(LEAST_LAG, 2, "firings", reasoned, "the shortest lag that is a hypothesis", "not ablated") \
    X(LAGS, 8, "hypotheses", size, "of lag, one firing apart", "not ablated") \
    X(OFFSETS, 6, "hypotheses", size, "of an axis offset", "not ablated") \
    X(OFFSET_STEP_CDEG, 600, "cdeg", reasoned, "from one axis offset to the next; the smallest is two steps, as a wall fills cones alike that are 6 degrees apart", "with the two rules of the same note: found 126 -> 119") \
    X(ARRAYS_MAX, 4, "arrays", size, "that may be dark", "not ablated") \
    X(RATE_ONE, 16, "-", size, "one reading in a rate", "not ablated")

// One thing: places, bearings, readings
#define ARGUS_ONE_THING_TABLE(X) \
    X(SAME_CDEG, 300, "cdeg", reasoned, "pings closer than this are on one bearing", "not ablated") \
    X(BESIDE_CDEG, 500, "cdeg", reasoned, "at a step of what is seen a reading may be of either side", "not ablated") \
    X(BESIDE_MS, 10000, "ms", reasoned, "... where another heard it so lately", "not ablated") \
    X(SAME_LATERAL_MM, 60, "mm", reasoned, "across the bearing: pings closer than this are from one place", "not ablated") \
    X(SAME_ALONG_MM, 200, "mm", reasoned, "... along it; gaps are counted anew after this way", "not ablated") \
    X(AGREE_MM, 80, "mm", reasoned, "by so much two echoes of one thing differ", "not ablated") \
    X(AGREE_PERCENT, 5, "%", reasoned, "... and by this part of the range", "not ablated") \
    X(NEAREST_MM, 150, "mm", reasoned, "what would be nearer is no evidence", "not ablated") \
    X(SURE_MM, 4000, "mm", reasoned, "from here on the air decides whether an echo is heard", "not ablated") \
    X(FARTHEST_MM, 4600, "mm", reasoned, "beyond no sonar need hear it", "not ablated") \
    X(LASTING_MM, 3500, "mm", reasoned, "echoes from beyond come and go", "not ablated") \
    X(NEAR_MM, 2500, "mm", reasoned, "a thing that no sonar on its bearing can miss; from here on an echo is a far one", "not ablated") \
    X(STRETCH_MM, 400, "mm", reasoned, "of way makes a measure of its ranges, or a piece of evidence beside a wall", "not ablated") \
    X(LEAP_MM, 450, "mm", reasoned, "no person walks so far between two firings of one sonar", "not ablated") \
    X(STILL_MM, 12, "mm", reasoned, "less way than this may leave a reading as it is", "not ablated") \
    X(STILL_CDEG, 150, "cdeg", reasoned, "... and less turn", "not ablated") \
    X(ONE_PING_MM, 30, "mm", reasoned, "readings at rest that differ by less are one ping", "without: a sonar that is out comes back by standing still") \
    X(ONE_PING_PLACE_MM, 5, "mm", reasoned, "... from places so near", "not ablated") \
    X(ONE_PING_CDEG, 30, "cdeg", reasoned, "... on bearings so near", "not ablated") \
    X(LAG_SAME_CDEG, 1000, "cdeg", reasoned, "from one place a lag that turned less has the sonar look where it looks now", "not ablated")

// Independence: one place and one moment are one piece of evidence
#define ARGUS_INDEPENDENCE_TABLE(X) \
    X(PLACE_MM, 200, "mm", measured, "readings from places this far apart count anew", "60 mm: half as many false names again") \
    X(SCAN_PLACE_MM, 80, "mm", reasoned, "... where a laser contradicts: its scan is of now", "not ablated") \
    X(PLACE_CDEG, 800, "cdeg", measured, "... on bearings this far apart", "5 degrees: likewise") \
    X(PLACE_MS, 4000, "ms", reasoned, "... or after this time", "not ablated") \
    X(EPISODE_MS, 6000, "ms", reasoned, "contradictions further apart are two episodes", "not ablated") \
    X(EPISODES, 10, "episodes", reasoned, "for a conviction: what moves about the robot does not contradict the same sonar again and again", "4: the healthy gain nothing") \
    X(FADES_S, 60, "s", measured, "in which what the others contradict fades", "30: slow sonars are forgotten between two turns") \
    X(FADE_MS, 1000, "ms", reasoned, "from one step of fading to the next", "not ablated") \
    X(RATE_KEEPS_EIGHTHS, 7, "/8", reasoned, "of a rate is kept each second", "not ablated") \
    X(RATE_EARLIER, 6, "readings", reasoned, "are taken for granted at the start of a rate", "not ablated") \
    X(DEAF_EARLIER, 12, "readings", reasoned, "heard as others did, but one, are taken for granted of the ring", "not ablated") \
    X(DEAF_EARLIER_OWN, 4, "readings", measured, "of each sonar, that hears as often as the ring, are taken for granted", "12: a tenth more false names of sonars as recorded, as many faults found") \
    X(DEAF_FADES_S, 120, "s", reasoned, "in which it fades how often a sonar was silent where another heard something", "not ablated") \
    X(RATE_OUTLIERS, 2, "sonars", reasoned, "that are odd by themselves: what more have in common is a disturbance", "not ablated") \
    X(ASKED_MOST, 104, "hypotheses", measured, "that one SIP weighs, some 3,000 instructions each", "110: as many instructions at worst")

// The pose of a ping
#define ARGUS_THE_POSE_OF_A_PING_TABLE(X) \
    X(PING_AGE_MS, 70, "ms", reasoned, "mean age of a ping in its SIP, which lists pings 0 to 140 ms old", "with the two rules of the same note: found 126 -> 119") \
    X(SIP_MOST_MS, 300, "ms", reasoned, "SIPs further apart give no pose between them", "not ablated") \
    X(ABOUT_CDEG, 12000, "cdeg", reasoned, "no robot turns so far in a SIP: the other end leads since then", "not ablated") \
    X(STEADY_SIPS, 2, "SIPs", reasoned, "without a rotation make a ping steady", "not ablated") \
    X(REST_SIPS, 3, "SIPs", reasoned, "at rest make a ping one at rest", "not ablated")

// Disturbance
#define ARGUS_DISTURBANCE_TABLE(X) \
    X(UNREST_MS, 8000, "ms", reasoned, "since something moved: contradictions count less", "not ablated") \
    X(UNREST_PERCENT, 25, "%", reasoned, "... by this", "not ablated") \
    X(CALM_MS, 30000, "ms", reasoned, "since something moved or a crowd was about: convictions are possible", "not ablated") \
    X(CROWD_PERMILLE, 350, "permille", reasoned, "of all readings contradicted: people are about", "not ablated") \
    X(WALK_MM, 70, "mm", reasoned, "between two readings at rest: a person walks", "not ablated")

// Sums
#define ARGUS_SUMS_TABLE(X) \
    X(CEILING, 3000, "cnat", reasoned, "no sum is higher", "not ablated") \
    X(OUT_TIMES, 4, "times", reasoned, "what speaks for a sonar that is out counts so often", "not ablated")

// Readings of one sonar
#define ARGUS_READINGS_OF_ONE_SONAR_TABLE(X) \
    X(CLIPPED_MM, 105, "mm", reasoned, "the shortest readings are all alike", "not ablated") \
    X(ALIKE_MM, 20, "mm", reasoned, "a steady view changes by less", "not ablated") \
    X(PARALLEL_MM, 5, "mm", reasoned, "by more a range abeam changes where the wall is not along the way: more than the step of a half wave", "not ablated") \
    X(PARALLEL_HEARD_MM, 500, "mm", reasoned, "a wall as near as this is heard abeam", "not ablated") \
    X(STUCK_TURNED_CDEG, 2000, "cdeg", reasoned, "of turn under one reading are evidence: past square-on to a wall a range stays for less", "not ablated") \
    X(FAMILIAR_MM, 100, "mm", reasoned, "an echo goes on from one before to within this, and the way", "not ablated") \
    X(COMPARED, 2, "echoes", reasoned, "that one is compared with", "not ablated") \
    X(LOOKED_BACK, 10, "readings", reasoned, "in which an echo before is sought", "not ablated") \
    X(GAPS_MOST, 3, "gaps", reasoned, "of one place count: at the edge of what is heard an echo comes and goes", "with the two rules of the same note: found 126 -> 119") \
    X(SILENT_RUN, 4, "readings", reasoned, "in a row without an echo speak for one that was given up as garbage", "not ablated") \
    X(DROPOUT_MOVING_MAX, 1100, "cnat", reasoned, "gaps in motion alone never convict", "not ablated") \
    X(REPLAY_RUN, 2, "readings", reasoned, "one after the other that were given before are evidence", "not ablated") \
    X(REPLAY_RUN_MOST, 4, "readings", reasoned, "... and from here on no more", "not ablated")

// Suspicion, name, conviction
#define ARGUS_SUSPICION_NAME_CONVICTION_TABLE(X) \
    X(SUSPECT_PERCENT, 75, "%", reasoned, "of a name's level: a look is called for", "not ablated") \
    X(HELD_PERCENT, 25, "%", reasoned, "... a suspect is cleared below", "not ablated") \
    X(PARTNERS, 2, "sonars", reasoned, "must contradict, or prove an outage: which of two is wrong takes a third", "not ablated") \
    X(LATE_NAMING, 500, "cnat", reasoned, "for a lag: names slow", "not ablated") \
    X(LATE_ALONE, 750, "cnat", reasoned, "... where no third sonar contradicts it", "not ablated") \
    X(LATE_CONVINCING, 1375, "cnat", reasoned, "... convicts", "not ablated") \
    X(LATE_LEAD, 430, "cnat", reasoned, "... over any other fault", "not ablated") \
    X(OFFSET_NAMING, 1100, "cnat", reasoned, "for an axis offset: names wrong", "not ablated") \
    X(OFFSET_LEAD, 300, "cnat", reasoned, "... over any other fault", "not ablated") \
    X(OFFSET_CONTRADICTED, 300, "cnat", reasoned, "... and so much contradicted", "not ablated") \
    X(SILENT_CONTRADICTED, 380, "cnat", reasoned, "contradicted for silence only: names off", "not ablated") \
    X(SILENT_OF, 3, "readings", measured, "contradicted, all of them silent: off", "2: 0.5 s sooner, twice the false names of off") \
    X(OFF_RUN, 5, "readings", reasoned, "in a row without an echo: off rather than intermittent", "not ablated") \
    X(OFF_RUN_LONG, 12, "readings", reasoned, "... of one whose echoes others have confirmed", "not ablated")

// Range limits: readings that no standing thing gives
#define ARGUS_RANGE_LIMITS_TABLE(X) \
    X(SHORTEST_NOISE_MM, 5, "mm", reasoned, "the shortest readings end so far above the robot's least; a run stays within", "not ablated") \
    X(SHORTEST_TURNED_CDEG, 1000, "cdeg", reasoned, "a turn beyond this may have put something else there", "not ablated") \
    X(SHORTEST_TURNED_ABEAM_CDEG, 2500, "cdeg", reasoned, "... so near that a sonar on the same side would still hear it", "not ablated") \
    X(SHORTEST_AWAY_MM, 200, "mm", reasoned, "gone away from what stays so near: proof", "without the rule: no goal 18 -> 30 of 480") \
    X(SHORTEST_ALONG_PERCENT, 96, "%", reasoned, "cosine of 15 degrees: nearer to the way no wall beside keeps a range", "not ablated") \
    X(SHORTEST_ABEAM_MM, 250, "mm", reasoned, "gone past what a sonar on the same side does not hear: proof", "not ablated") \
    X(SHORTEST_ALONE_MM, 2000, "mm", reasoned, "... without such a sonar: no robot drives so long so near a wall", "not ablated") \
    X(SHORTEST_CLEAR_MM, 300, "mm", reasoned, "the other one reads so much more", "not ablated") \
    X(SHORTEST_BESIDE_CDEG, 6000, "cdeg", reasoned, "apart at most: another one hears as near what this one hears at its least", "without: 26 healthy ones given up in 50 minutes among people who walk into the robot") \
    X(SHORTEST_FAR_MM, 600, "mm", reasoned, "so far above the least nothing stood that is at the least one firing later", "not ablated") \
    X(SHORTEST_NEAR_MM, 150, "mm", reasoned, "so far above the least an echo forbids to turn", "not ablated") \
    X(IMPOSSIBLE_LEAPS, 31, "-", measured, "weight of a leap to the least", "16: none of 30 found at 3 %; 64: a healthy one given up") \
    X(IMPOSSIBLE_VISIT, 10, "-", measured, "weight of a leap near and away again at once: a person may do so once or twice", "without: goals 285 -> 268 of 288") \
    X(IMPOSSIBLE_ROW, 5, "readings", reasoned, "below the least convict; so many one after the other: stuck rather than intermittent", "not ablated") \
    X(IMPOSSIBLE_CONVICTS, 80, "-", reasoned, "sum of the weights, one less for each sound reading: convicts; above half of it, it is too early to try it again", "not ablated") \
    X(IMPOSSIBLE_MAX, 120, "-", reasoned, "... no sum is higher", "not ablated")

// Outage of an array
#define ARGUS_OUTAGE_OF_AN_ARRAY_TABLE(X) \
    X(DARK_LEAST, 4, "sonars", reasoned, "in use that make an array", "not ablated") \
    X(DARK_LEAST_OF_SOME, 5, "sonars", measured, "... where others of it go on hearing: a person hides four", "4: four healthy ones given up behind a person") \
    X(DARK_RUN, 3, "readings", reasoned, "of each without an echo, before what ended at once is proof", "not ablated") \
    X(DARK_RUN_OF_SOME, 9, "readings", reasoned, "... where two of it or more go on hearing: what a person leaves behind may be silent, too", "3: five healthy ones given up at once in 2.5 h among people") \
    X(DARK_AT_ONCE_CNAT, 980, "cnat", measured, "that those which stopped at once tell together, by how often each is silent where something stands; less is a doubt, and proof after a stretch of way", "0: eight healthy ones given up in 1.2 h of sonars as recorded") \
    X(DARK_AT_ONCE_MS, 450, "ms", reasoned, "the echoes that it lost ended within a round and a SIP of each other", "not ablated") \
    X(DARK_TURNING_PER_MM, 5, "-", reasoned, "wheels that differ by a part of their distance, 11 degrees/s: the robot turned", "not ablated") \
    X(DARK_APART_MM, 400, "mm", reasoned, "driven from one reading to the next, at most", "not ablated") \
    X(DARK_PASSED_MM, 1500, "mm", reasoned, "driven beside such things, both sides together, and a stretch on either: proof", "without the proof: collisions 0 -> 2 of 60") \
    X(DARK_GOES_ON_MM, 200, "mm", reasoned, "an echo of one thing goes on from the one before, less the way, to within this", "not ablated") \
    X(DARK_AHEAD_DEG, 30, "degrees", reasoned, "what looks so far off the way cannot pass by what it heard", "not ablated") \
    X(DARK_AHEAD_LEAST_MM, 300, "mm", reasoned, "... while so much of it is left", "not ablated") \
    X(DARK_PIECE_CNAT, 280, "cnat", reasoned, "for a stretch of a wall beside it, and for each sonar that has lost something ahead", "not ablated") \
    X(DARK_DOUBT_CNAT, 560, "cnat", reasoned, "the level of a suspicion of the array; what the body met is worth it at once", "not ablated") \
    X(DARK_PROOF_CNAT, 2200, "cnat", reasoned, "... of its conviction", "not ablated")

// Ranges against the odometry
#define ARGUS_RANGES_AGAINST_THE_ODOMETRY_TABLE(X) \
    X(SCALE_ASIDE, 4, "-", reasoned, "the way may lie aside of the bearing by this part of it", "not ablated") \
    X(SCALE_FITS_PERCENT, 10, "%", reasoned, "a measure that is off by less fits", "not ablated") \
    X(SCALE_OFF_RUN, 4, "measures", reasoned, "in a row that are off to one side: what is slant or round is short, too", "without the rule: false disables 0 -> 7 of 12 missions") \
    X(SCALE_LEAST_OFF, 2, "sonars", reasoned, "of an array, before it is taken for off as a whole", "not ablated")

// The scan of a laser as a whole
#define ARGUS_LASER_TABLE(X) \
    X(SCANS, 32, "readings", size, "of all sectors that are remembered: some 3 s", "not ablated") \
    X(SCAN_LAGS, 5, "hypotheses", size, "of a laser's lag", "not ablated") \
    X(SCAN_WALLS, 6, "-", size, "walls that are followed at a time", "not ablated") \
    X(SCAN_SAME_MS, 800, "ms", reasoned, "in which no sector of a scan changes while the robot moves: frozen", "not ablated") \
    X(SCAN_SAME_MM, 100, "mm", reasoned, "... so far", "not ablated") \
    X(SCAN_SAME_CDEG, 1000, "cdeg", reasoned, "... or turns by so much", "not ablated") \
    X(SCAN_DARK_MS, 1000, "ms", reasoned, "without a return in any sector, right after half of them had near ones: dark", "not ablated") \
    X(SCAN_CUT_WAY_MM, 3000, "mm", reasoned, "of way in which returns end at one range: cut", "not ablated") \
    X(SCAN_CUT_EDGES, 10, "-", reasoned, "... so often", "not ablated") \
    X(SCAN_CUT_TIMES, 4, "times", reasoned, "... as often as anywhere nearer", "not ablated") \
    X(SCAN_CUT_PERCENT, 85, "%", reasoned, "of the farthest return: from here on a return ends there", "not ablated") \
    X(SCAN_CUT_MOST_MM, 4000, "mm", reasoned, "a return from beyond: nothing is cut", "not ablated") \
    X(SCAN_WALL_LEAST_MM, 300, "mm", reasoned, "a wall that is nearer is no measure", "not ablated") \
    X(SCAN_WALL_LEAP_MM, 150, "mm", reasoned, "of a wall's range from scan to scan", "not ablated") \
    X(SCAN_WALL_MISSED, 3, "readings", reasoned, "in a row do not show it: it is lost", "not ablated") \
    X(SCAN_DROPPED_PERCENT, 40, "%", reasoned, "of the way: what is farther off the way is no wall that stands", "not ablated") \
    X(SCAN_STRETCH_MM, 300, "mm", reasoned, "of way makes a measure of a wall's range", "not ablated") \
    X(SCAN_BENT_CDEG, 1000, "cdeg", reasoned, "... whose foot is seen on one bearing, to within this", "not ablated") \
    X(SCAN_MEASURES, 3, "measures", reasoned, "of a stretch each, along the way for the scale, across it for the axis", "not ablated") \
    X(SCAN_KEEPS_SIXTEENTHS, 15, "-", reasoned, "sixteenths of the measures so far are kept with one more", "not ablated") \
    X(SCAN_TURNED_PERMILLE, 100, "permille", reasoned, "sine of the angle by which its axis is off: turned", "not ablated") \
    X(SCAN_SCALED_PERMILLE, 60, "permille", reasoned, "ranges change by so much more or less than the way: scaled", "not ablated") \
    X(RADIAN_CDEG, 5730, "cdeg", reasoned, "a radian, rounded", "not ablated") \
    X(SCAN_SLOT_MS, 100, "ms", reasoned, "from one scan to the next, about", "not ablated") \
    X(SCAN_FAINT_CDEG, 500, "cdeg", measured, "so near to the rim of its cone a sonar may miss what a laser returns", "300: 7 % of the edges are missed, 0.1 % of the walls") \
    X(SCAN_LATE_STEP_MS, 500, "ms", reasoned, "from one lag that is tried to the next", "not ablated") \
    X(SCAN_LATE_SCANS, 15, "readings", reasoned, "in turns that tell a lag from none", "not ablated") \
    X(SCAN_LATE_PERCENT, 150, "%", reasoned, "of the misfit with the lag, without it: late", "not ablated") \
    X(SCAN_MISFIT_MM, 1000, "mm", reasoned, "the most that one sector misfits", "not ablated")

// Alarms
#define ARGUS_ALARMS_TABLE(X) \
    X(MOVING_MM_S, 5, "mm/s", reasoned, "faster, the robot moves ahead or back", "not ablated")

// All of them, by what they are about.
#define ARGUS_NUMBER_TABLE(X) \
    ARGUS_SIZES_TABLE(X) \
    ARGUS_ONE_THING_TABLE(X) \
    ARGUS_INDEPENDENCE_TABLE(X) \
    ARGUS_THE_POSE_OF_A_PING_TABLE(X) \
    ARGUS_DISTURBANCE_TABLE(X) \
    ARGUS_SUMS_TABLE(X) \
    ARGUS_READINGS_OF_ONE_SONAR_TABLE(X) \
    ARGUS_SUSPICION_NAME_CONVICTION_TABLE(X) \
    ARGUS_RANGE_LIMITS_TABLE(X) \
    ARGUS_OUTAGE_OF_AN_ARRAY_TABLE(X) \
    ARGUS_RANGES_AGAINST_THE_ODOMETRY_TABLE(X) \
    ARGUS_LASER_TABLE(X) \
    ARGUS_ALARMS_TABLE(X)

// Each test of a sonar: permille of the readings that are odd of a healthy sonar at the least, odd of a faulty one, and
// even of a faulty one (what is neither is no evidence); in cnat the level that names, the one that convicts, the floor.
#define ARGUS_TEST_NUMBERS(X) \
    X(STUCK, 60, 1000, 0, 1300, 1800, 0) \
    X(GARBAGE, 100, 600, 50, 500, 2800, 0) \
    X(DROPOUT, 10, 250, 750, 800, 2700, 0) \
    X(PEERS, 50, 800, 370, 750, 2200, -150)
// clang-format on

#define ARGUS_NUMBER(name, value, unit, source, what, trial) ARGUS_##name = (value),
enum { ARGUS_NUMBER_TABLE(ARGUS_NUMBER) };
#undef ARGUS_NUMBER

#endif
