// SPDX-License-Identifier: MIT
// CRC-32/MPEG-2 over 32-bit words, one bit per clock: polynomial 0x04C11DB7, start 0xFFFFFFFF, MSB first, no
// final inversion. The CRC unit of an STM32F103 computes the same.
//
// Promise: `start` takes `word`; `busy` is high for the 32 clocks after it, then `crc` includes the word. A
// word equal to the CRC so far leads to 0. `restart` begins anew and wins over a shift; it may come together
// with `start`.
`resetall
`default_nettype none

module passo_crc (
  input  wire        clk,
  input  wire        rst,
  input  wire        restart,
  input  wire        start,
  input  wire [31:0] word,
  output reg  [31:0] crc,
  output reg         busy
);

  localparam [31:0] POLYNOMIAL = 32'h04C11DB7;

  reg [31:0] remaining;
  reg [ 4:0] count;

  wire feedback = crc[31] ^ remaining[31];

  always @(posedge clk) begin
    if (busy) begin
      crc       <= {crc[30:0], 1'b0} ^ (feedback ? POLYNOMIAL : 32'd0);
      remaining <= {remaining[30:0], 1'b0};
      count     <= count - 5'd1;
      busy      <= count != 5'd0;
    end
    if (start) begin
      remaining <= word;
      count     <= 5'd31;
      busy      <= 1'b1;
    end
    if (restart) begin
      crc  <= 32'hFFFF_FFFF;
      busy <= start;
    end
    if (rst) busy <= 1'b0;
  end

`ifdef FORMAL
  `include "passo_crc_formal.vh"
`endif

endmodule
`resetall
