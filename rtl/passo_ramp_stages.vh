// SPDX-License-Identifier: MIT
// Stages of passo_ramp, and the clocks of each; see passo_ramp_schedule.v.

/* verilator lint_off UNUSEDPARAM */
localparam [2:0] STAGE_CHOOSE = 3'd0;
localparam [2:0] STAGE_COPY = 3'd1;
localparam [2:0] STAGE_FETCH = 3'd2;
localparam [2:0] STAGE_TAKE = 3'd3;
localparam [2:0] STAGE_LOOK_UP = 3'd4;
localparam [2:0] STAGE_SHAPE = 3'd5;
localparam [2:0] STAGE_SCALE = 3'd6;
localparam [2:0] STAGE_ADVANCE = 3'd7;

localparam [5:0] COPY_CLOCKS = 6'd24;
localparam [5:0] FETCH_CLOCKS = 6'd8;
localparam [5:0] TAKE_CLOCKS = 6'd5;
localparam [5:0] SHAPE_CLOCKS = 6'd19;
localparam [5:0] SCALE_CLOCKS = 6'd50;
localparam [5:0] ADVANCE_CLOCKS = 6'd8;
/* verilator lint_on UNUSEDPARAM */
