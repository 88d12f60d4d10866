// SPDX-License-Identifier: MIT
// What passo_ramp is doing.

/* verilator lint_off UNUSEDPARAM */

localparam [2:0] STEP_CHOOSE = 3'd0;
localparam [2:0] STEP_COPY = 3'd1;  // v_start is the present velocity
localparam [2:0] STEP_FETCH = 3'd2;  // the next ramp
localparam [2:0] STEP_TAKE = 3'd3;  // v_start is v_end: the ramp is over
localparam [2:0] STEP_LOOK_UP = 3'd4;
localparam [2:0] STEP_SHAPE = 3'd5;
localparam [2:0] STEP_SCALE = 3'd6;
localparam [2:0] STEP_STEP = 3'd7;  // u += du
/* verilator lint_on UNUSEDPARAM */
