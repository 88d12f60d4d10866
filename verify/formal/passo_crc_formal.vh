// SPDX-License-Identifier: MIT
// Promises of the CRC unit; included at the end of passo_crc.v.

localparam [31:0] F_POLYNOMIAL = 32'h04C11DB7;

// --- The standard: the CRC of a word is (CRC xor word), shifted 32 times with zeros following
reg        f_known = 1'b0;  // there has been a restart
reg [31:0] f_standard;
reg [31:0] f_word;  // bits still to come, MSB first
reg [ 5:0] f_left = 6'd0;  // their number; 0: between words
reg        f_is_own;  // the word equals the CRC before it
(* anyseq *) reg [31:0] f_any_word;
wire [31:0] f_word_now = f_left == 6'd0 ? f_any_word : f_word;
wire [31:0] f_standard_now = f_left == 6'd0 ? f_standard ^ f_any_word : f_standard;

// --- Rotation: the CRC before, and the rotations so far
reg [31:0] f_before;
reg [ 4:0] f_rotations = 5'd0;

always @(posedge clk) begin
  // the incoming bits form a word
  if (shift && !rotate) crc_any_word : assume (data == f_word_now[31]);

  if (shift && !rotate) begin
    f_left     <= f_left == 6'd0 ? 6'd31 : f_left - 6'd1;
    f_word     <= f_word_now << 1;
    f_standard <= {f_standard_now[30:0], 1'b0} ^ (f_standard_now[31] ? F_POLYNOMIAL : 32'd0);
    if (f_left == 6'd0) f_is_own <= f_any_word == f_standard;
  end
  if (shift && rotate) begin
    f_rotations <= f_rotations + 5'd1;
    if (f_rotations == 5'd0) f_before <= crc;
    if (f_known)
      rotation_shows_the_crc :
      assert (top == (f_rotations == 5'd0 ? crc[31] : f_before[5'd31 - f_rotations]));
  end
  // a mix of words and rotations means nothing, until the next restart
  if (shift && (rotate ? f_left != 6'd0 : f_rotations != 5'd0)) f_known <= 1'b0;
  if (restart) begin
    f_known    <= 1'b1;
    f_standard <= 32'hFFFF_FFFF;
    f_left     <= 6'd0;
    f_rotations    <= 5'd0;
    f_is_own   <= 1'b0;
  end
  if (f_known && f_left == 6'd0 && f_rotations == 5'd0) begin
    crc_is_the_standards : assert (crc == f_standard);
    if (f_is_own) own_crc_leads_to_0 : assert (crc == 32'd0 || $past(rotate));
  end
  if (f_known && f_rotations == 5'd0 && $past(f_rotations) == 5'd31 && $past(shift && !restart))
    rotation_keeps_the_crc : assert (crc == f_before);
  if (f_known && $past(restart)) restart_wins : assert (crc == 32'hFFFF_FFFF);
end

wire [63:0] f_rotated = {f_before, f_before} << f_rotations;
always @(posedge clk)
  if (f_known) begin
    assert (f_left <= 6'd31);
    if (f_left != 6'd0) assert (crc == (f_standard ^ f_word) && (f_word << f_left) == 32'd0 && f_rotations == 5'd0);
    if (f_rotations != 5'd0) assert (crc == f_rotated[63:32] && f_before == f_standard && f_left == 6'd0);
    if (f_is_own && f_left != 6'd0) assert (f_standard == 32'd0);
    if (f_is_own && f_left == 6'd0) assert (f_standard == 32'd0);
  end
