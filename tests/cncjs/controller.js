// SPDX-License-Identifier: MIT
// The controller of cncjs for grbl, as published, at a serial port: node controller.js PORT.
// Standard input has its commands, one JSON list a line; standard output what it tells its web pages, the same way.
'use strict';
const readline = require('readline');
const { default: GrblController } = require('cncjs/dist/cncjs/server/controllers/Grbl/GrblController');

const controller = new GrblController({ io: null }, { port: process.argv[2], baudrate: 115200, rtscts: false });
const tell = (...event) => console.log(JSON.stringify(event));

controller.addConnection({ id: 'passo', emit: tell });
controller.open((error) => error && process.exit(1));
readline.createInterface({ input: process.stdin })
  .on('line', (line) => controller.command(...JSON.parse(line)))
  .on('close', () => controller.close(() => process.exit(0)));
