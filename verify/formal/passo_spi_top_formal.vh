// SPDX-License-Identifier: MIT
// Promises of the top with SPI; included at the end of passo_spi_top.v. Core and SPI give back what comes in
// (passo_core_model.v, passo_spi_model.v).

always @* begin
  pins_go_in_and_out :
  assert (step == limit_low && dir == limit_high && enable == (home ^ encoder_index)
          && outputs == {alarm ^ encoder_a, encoder_b} && power == probe && compare == sync
          && running == estop_n && irq == rst);
  drives_miso_when_selected : assert (spi_miso_enable == !spi_cs_n);
  // the model gives back the parity
  bits_go_in_and_out : assert (spi_miso == (spi_cs_n ^ spi_sclk ^ spi_mosi));
end
