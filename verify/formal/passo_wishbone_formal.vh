// SPDX-License-Identifier: MIT
// Promises of the Wishbone front; included at the end of passo_wishbone.v. Core and host interface give back what comes
// in (passo_core_model.v, passo_words_model.v).

reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) wishbone_reset : assume (rst);
end

// --- The pins
always @* begin
  pins_go_in_and_out :
  assert (step == limit_low && dir == limit_high && enable == (home ^ encoder_index)
          && outputs == {alarm ^ encoder_a, encoder_b} && power == probe && compare == sync
          && running == estop_n && irq == rst);
end

// --- The words
wire f_asked = wb_cyc_i & wb_stb_i;
always @* begin
  words_go_in_and_out :
  assert (wb_dat_o == {wb_dat_i[31:16], wb_dat_i[27:16] ^ {4'd0, wb_dat_i[7:0]}, wb_sel_i ^ {1'b0, f_asked, wb_we_i, wb_adr_i[2]}});
  one_answer : assert (!(wb_ack_o && wb_err_o));
end
wire f_answer = wb_ack_o | wb_err_o;
always @(posedge clk)
  if (f_started) begin
    if (f_answer) answers_when_asked : assert ($past(f_asked && !f_answer && !rst));
    if (f_answer) errors_are_told : assert (wb_err_o == $past(wb_dat_i[15] ^ wb_adr_i[2]));
  end
