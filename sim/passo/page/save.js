// SPDX-License-Identifier: MIT
// Saves results: a file with every step, the report page, a picture of the charts.
"use strict";

const MARGIN_PNG = 16, HEAD_PNG = 26;  // CSS pixels

function save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// A report as `passo run --report` writes it, of the styles and scripts of this page.
function reportPage(facts, edges) {
    const parts = {
        "<!-- title -->": facts.summary.name,
        "/* styles */": document.querySelector("style").textContent,
        "/* scripts */": document.querySelector("script").textContent,
        "<!-- body -->": [
            `<script type="application/json" id="facts">${JSON.stringify(facts).replaceAll("</", "<\\/")}</` + "script>",
            `<script type="text/plain" id="edges">${edges}</` + "script>",
            "<script>openReport();</" + "script>",
        ].join("\n"),
    };
    const shell = JSON.parse(document.getElementById("shell").textContent);
    return shell.replace(/<!-- title -->|\/\* styles \*\/|\/\* scripts \*\/|<!-- body -->/g, part => parts[part]);
}

// What the charts show now, one below the other.
function picture() {
    const panels = [...document.querySelectorAll("#charts .panel, #side .panel")].filter(panel => panel.querySelector("canvas"));
    const ratio = devicePixelRatio, height = panel => HEAD_PNG + panel.querySelector("canvas").clientHeight;
    const canvas = document.createElement("canvas"), ctx = canvas.getContext("2d");
    canvas.width = (Math.max(...panels.map(panel => panel.clientWidth)) + 2 * MARGIN_PNG) * ratio;
    canvas.height = (panels.reduce((sum, panel) => sum + height(panel), 0) + 2 * MARGIN_PNG) * ratio;
    ctx.fillStyle = styleOf("--panel");
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.scale(ratio, ratio);
    let y = MARGIN_PNG;
    for (const panel of panels) {
        const drawn = panel.querySelector("canvas");
        ctx.fillStyle = styleOf("--ink");
        ctx.font = "600 13px system-ui";
        ctx.fillText(panel.querySelector("h2").textContent, MARGIN_PNG, y + 14);
        ctx.fillStyle = styleOf("--faint");
        ctx.font = "12px system-ui";
        ctx.textAlign = "right";
        ctx.fillText(panel.querySelector(".note")?.textContent ?? "", canvas.width / ratio - MARGIN_PNG, y + 14);
        ctx.textAlign = "left";
        ctx.drawImage(drawn, MARGIN_PNG, y + HEAD_PNG, drawn.clientWidth, drawn.clientHeight);
        y += height(panel);
    }
    return new Promise(resolve => canvas.toBlob(resolve, "image/png"));
}
