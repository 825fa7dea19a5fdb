/* Sums of DOP853 for component i, a number or a vector; k[j][i] is its rate at stage j, counted from 0. */
#ifndef STAGES_H
#define STAGES_H

#include "dop853.h"

#define STAGE_1 (A2_1 * k[0][i])
#define STAGE_2 (A3_1 * k[0][i] + A3_2 * k[1][i])
#define STAGE_3 (A4_1 * k[0][i] + A4_3 * k[2][i])
#define STAGE_4 (A5_1 * k[0][i] + A5_3 * k[2][i] + A5_4 * k[3][i])
#define STAGE_5 (A6_1 * k[0][i] + A6_4 * k[3][i] + A6_5 * k[4][i])
#define STAGE_6 (A7_1 * k[0][i] + A7_4 * k[3][i] + A7_5 * k[4][i] + A7_6 * k[5][i])
#define STAGE_7 (A8_1 * k[0][i] + A8_4 * k[3][i] + A8_5 * k[4][i] + A8_6 * k[5][i] + A8_7 * k[6][i])
#define STAGE_8 (A9_1 * k[0][i] + A9_4 * k[3][i] + A9_5 * k[4][i] + A9_6 * k[5][i] + A9_7 * k[6][i] + \
    A9_8 * k[7][i])
#define STAGE_9 (A10_1 * k[0][i] + A10_4 * k[3][i] + A10_5 * k[4][i] + A10_6 * k[5][i] + A10_7 * k[6][i] + \
    A10_8 * k[7][i] + A10_9 * k[8][i])
#define STAGE_10 (A11_1 * k[0][i] + A11_4 * k[3][i] + A11_5 * k[4][i] + A11_6 * k[5][i] + A11_7 * k[6][i] + \
    A11_8 * k[7][i] + A11_9 * k[8][i] + A11_10 * k[9][i])
#define STAGE_11 (A12_1 * k[0][i] + A12_4 * k[3][i] + A12_5 * k[4][i] + A12_6 * k[5][i] + A12_7 * k[6][i] + \
    A12_8 * k[7][i] + A12_9 * k[8][i] + A12_10 * k[9][i] + A12_11 * k[10][i])
#define MEAN (B_1 * k[0][i] + B_6 * k[5][i] + B_7 * k[6][i] + B_8 * k[7][i] + B_9 * k[8][i] + \
    B_10 * k[9][i] + B_11 * k[10][i] + B_12 * k[11][i])
#define FIFTH (E5_1 * k[0][i] + E5_6 * k[5][i] + E5_7 * k[6][i] + E5_8 * k[7][i] + E5_9 * k[8][i] + \
    E5_10 * k[9][i] + E5_11 * k[10][i] + E5_12 * k[11][i])
#define THIRD (E3_1 * k[0][i] + E3_6 * k[5][i] + E3_7 * k[6][i] + E3_8 * k[7][i] + E3_9 * k[8][i] + \
    E3_10 * k[9][i] + E3_11 * k[10][i] + E3_12 * k[11][i])

#endif
