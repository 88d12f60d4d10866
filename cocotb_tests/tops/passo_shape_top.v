// SPDX-License-Identifier: MIT
// Shape with its tables: the last channel is the shape's, the others ask as the test says.
`resetall
`default_nettype none

module passo_shape_top #(
  parameter CHANNELS = 1
) (
  input  wire                   clk,
  input  wire                   rst,
  // shape
  input  wire                   start,
  input  wire [           24:0] progress,
  input  wire [            1:0] shape,
  input  wire                   mirror,
  output wire                   done,
  output wire [           24:0] s,
  // bus of the tables
  input  wire                   bus_check,
  input  wire                   bus_write,
  input  wire                   bus_read,
  input  wire                   bus_push,
  input  wire                   select,
  input  wire [            9:0] bus_address,
  input  wire [           31:0] bus_data,
  input  wire                   occupied,
  output wire [            3:0] refusal,
  // the other channels
  input  wire [   CHANNELS-1:0] request,       // the uppermost bit means nothing
  input  wire [CHANNELS*10-1:0] address,
  output wire [   CHANNELS-1:0] served,
  output wire [           15:0] point,
  output wire [           15:0] point_next,
  output wire                   shape_request
);

  wire [            9:0] shape_address;
  wire [   CHANNELS-1:0] requests;
  wire [CHANNELS*10-1:0] addresses;

  genvar channel;
  generate
    for (channel = 0; channel < CHANNELS; channel = channel + 1) begin : g_channel
      assign requests[channel]         = channel == CHANNELS - 1 ? shape_request : request[channel];
      assign addresses[channel*10+:10] = channel == CHANNELS - 1 ? shape_address : address[channel*10+:10];
    end
  endgenerate

  passo_shape u_shape (
    .clk             (clk),
    .rst             (rst),
    .start           (start),
    .progress        (progress),
    .shape           (shape),
    .mirror          (mirror),
    .done            (done),
    .s               (s),
    .table_request   (shape_request),
    .table_address   (shape_address),
    .table_served    (served[CHANNELS-1]),
    .table_point     (point),
    .table_point_next(point_next)
  );

  passo_tables #(
    .CHANNELS(CHANNELS)
  ) u_tables (
    .clk        (clk),
    .rst        (rst),
    .bus_check  (bus_check),
    .bus_write  (bus_write),
    .bus_read   (bus_read),
    .bus_push   (bus_push),
    .select     (select),
    .bus_address(bus_address),
    .bus_data   (bus_data),
    .occupied   (occupied),
    .refusal    (refusal),
    .request    (requests),
    .address    (addresses),
    .served     (served),
    .point      (point),
    .point_next (point_next)
  );

endmodule
`resetall
