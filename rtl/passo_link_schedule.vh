// SPDX-License-Identifier: MIT
// Clocks of the schedule that each word of a frame follows; see passo_link_schedule.v.
/* verilator lint_off UNUSEDPARAM */
localparam [6:0] COUNT_READ = 7'd13;
localparam [6:0] COUNT_LOAD = 7'd28;
localparam [6:0] COUNT_LOADED = 7'd31;
localparam [6:0] COUNT_ROTATE = 7'd32;  // .. 63
localparam [6:0] COUNT_HALF = 7'd47;  // last rotation of the upper half
localparam [6:0] COUNT_ACT = 7'd65;
localparam [6:0] COUNT_REST = 7'd67;
/* verilator lint_on UNUSEDPARAM */
