// SPDX-License-Identifier: MIT
// What the CRC unit promises; included at the end of passo_crc.

// --- Assumptions: a word comes only when the last one is done, or with a restart
reg f_begun = 1'b0;
always @(posedge clk) begin
  f_begun <= 1'b1;
  assume (rst == !f_begun);
  if (start) assume (!busy || restart);
end

// --- The standard's own loop over a word: MSB first, polynomial 0x04C11DB7
function [31:0] f_crc_of(input [31:0] f_before, input [31:0] f_word);
  integer f_i;
  begin
    f_crc_of = f_before ^ f_word;
    for (f_i = 0; f_i < 32; f_i = f_i + 1)
      f_crc_of = f_crc_of[31] ? {f_crc_of[30:0], 1'b0} ^ 32'h04C11DB7 : {f_crc_of[30:0], 1'b0};
  end
endfunction

reg [31:0] f_crc;  // what the unit must show when it is not busy
reg [31:0] f_word;
reg        f_is_word = 1'b0;  // the word taken equals the CRC so far
reg        f_known = 1'b0;  // there has been a restart
reg [ 5:0] f_busy = 6'd0;
always @(posedge clk) begin
  if (restart) f_known <= 1'b1;
  if (restart) f_crc <= start ? f_crc_of(32'hFFFF_FFFF, word) : 32'hFFFF_FFFF;
  else if (start) f_crc <= f_crc_of(f_crc, word);
  if (start) f_is_word <= word == (restart ? 32'hFFFF_FFFF : f_crc);
  else if (restart) f_is_word <= 1'b0;
  f_busy <= start ? 6'd32 : restart ? 6'd0 : f_busy == 6'd0 ? 6'd0 : f_busy - 6'd1;
  if (rst) f_busy <= 6'd0;
  if (rst) f_known <= 1'b0;
  if (rst) f_is_word <= 1'b0;
  if (f_begun) begin
    busy_for_32_clocks : assert (busy == (f_busy != 6'd0));
    if (f_known && !busy) crc_is_the_standards : assert (crc == f_crc);
    if (f_known && !busy && f_is_word) own_crc_leads_to_0 : assert (crc == 32'd0);
  end
end
