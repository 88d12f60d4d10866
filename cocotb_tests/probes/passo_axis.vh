// SPDX-License-Identifier: MIT
// The axis did not accept a step, a clock ago.

reg overrun;
always @(posedge clk) overrun <= step_request & full & ~rst;
