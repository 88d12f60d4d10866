// SPDX-License-Identifier: MIT
// Promises of the AXI4-Lite front; included at the end of passo_axi_lite.v. Core and host interface give back what
// comes in (passo_core_model.v, passo_words_model.v).

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) axi_reset : assume (rst);
  if (f_ran && $past(s_axil_awvalid && !s_axil_awready))
    axi_address_stands : assume (s_axil_awvalid && $stable(s_axil_awaddr));
  if (f_ran && $past(s_axil_wvalid && !s_axil_wready))
    axi_data_stand : assume (s_axil_wvalid && $stable(s_axil_wdata) && $stable(s_axil_wstrb));
  if (f_ran && $past(s_axil_arvalid && !s_axil_arready))
    axi_read_stands : assume (s_axil_arvalid && $stable(s_axil_araddr));
end

// --- The pins
always @* begin
  pins_go_in_and_out :
  assert (step == limit_low && dir == limit_high && enable == (home ^ encoder_index)
          && outputs == {alarm ^ encoder_a, encoder_b} && power == probe && compare == sync
          && running == estop_n && irq == rst);
end

// --- Accesses: an answer for each, none without
wire f_written = s_axil_awready & s_axil_awvalid;
wire f_read = s_axil_arready & s_axil_arvalid;
wire f_both = s_axil_awvalid & s_axil_wvalid & s_axil_arvalid;
reg  f_wrote = 1'b0;  // the last access was a write
wire f_writes = s_axil_awvalid & s_axil_wvalid & ~(f_wrote & s_axil_arvalid);
wire f_asks = (f_writes | s_axil_arvalid) & ~(s_axil_bvalid | s_axil_rvalid);
wire f_address = f_writes ? s_axil_awaddr[2] : s_axil_araddr[2];
wire [3:0] f_lanes = f_writes ? s_axil_wstrb : 4'hF;
always @(posedge clk) begin
  if (f_written || f_read) f_wrote <= f_written;
  if (rst) f_wrote <= 1'b0;
end

always @(posedge clk)
  if (f_ran) begin
    if (s_axil_awready) address_with_data : assert (s_axil_awvalid && s_axil_wvalid && s_axil_wready);
    if (s_axil_wready) data_with_address : assert (s_axil_awready);
    if (s_axil_arready) reads_when_asked : assert (s_axil_arvalid && !s_axil_awready);
    if ($past(f_both) && f_written) writes_in_turn : assert (!$past(f_wrote));
    if ($past(f_both) && f_read) reads_in_turn : assert ($past(f_wrote));
    write_answered : assert (s_axil_bvalid == ($past(s_axil_bvalid) ? $past(!s_axil_bready) : $past(f_written)));
    read_answered : assert (s_axil_rvalid == ($past(s_axil_rvalid) ? $past(!s_axil_rready) : $past(f_read)));
    one_at_a_time : assert (!(s_axil_bvalid && s_axil_rvalid));
    if (s_axil_bvalid || s_axil_rvalid) none_while_answering : assert (!s_axil_awready && !s_axil_arready);
    words_go_in_and_out :
    assert (s_axil_rdata == {
      s_axil_wdata[31:16], s_axil_wdata[27:16] ^ {4'd0, s_axil_wdata[7:0]}, f_lanes ^ {1'b0, f_asks, f_writes, f_address}
    });
    responses : assert (s_axil_bresp == s_axil_rresp && !s_axil_bresp[0]);
    errors_are_told : assert (s_axil_bresp[1] == $past(s_axil_wdata[15] ^ f_address));
  end else if (f_started) reset_answers : assert (!s_axil_bvalid && !s_axil_rvalid);

// --- What the induction relies on
always @(posedge clk)
  if (f_ran) begin
    assert (reads_next == f_wrote);
    assert (write_q == $past(f_writes));
    if (done) assert ($past(f_writes || s_axil_arvalid) && !answering);
  end
