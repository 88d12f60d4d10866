// SPDX-License-Identifier: MIT
// Plays a motion: what the charts show passes in some seconds, from all of a part down to single clocks.
"use strict";

const PLAY_SECONDS = 10;  // for what is shown
const OVERLAP = 0.05;  // of what was shown, when the next part is

class Player {
    constructor(bar, views) {
        Object.assign(this, { views, view: views[0], playing: 0 });
        this.button = element(bar, "button", "play", "▶ play");
        this.button.title = "pass through what is shown (space)";
        this.button.onclick = () => this.toggle();
        this.slider = element(bar, "input", "time");
        Object.assign(this.slider, { type: "range", min: 0, max: 1000, step: "any", value: 0 });
        this.slider.setAttribute("aria-label", "Time of the tool");
        this.slider.oninput = () => this.go(this.view.min + (this.view.max - this.view.min) * this.slider.value / 1000);
        this.rate = element(bar, "span", "note");
        this.view.listeners.push(this);
    }

    update() {
        const span = (this.view.max - this.view.min) / this.view.motion.hz / PLAY_SECONDS;
        this.rate.textContent = span >= 1 ? `${plain(span, 2)} × real time` : `1/${plain(1 / span, 2)} of real time`;
    }

    go(clock) {
        for (const view of this.views) view.point(clock);
        this.slider.value = 1000 * (clock - this.view.min) / (this.view.max - this.view.min);
    }

    toggle() {
        if (this.playing) return this.stop();
        const { view } = this, { pointer } = view;
        const begin = pointer === null || pointer < view.min || pointer >= Math.min(view.max, view.motion.clocks) ? Math.max(0, view.min) : pointer;
        this.button.textContent = "❚❚ pause";
        this.frame(performance.now(), begin);
    }

    stop() {
        cancelAnimationFrame(this.playing);
        this.playing = 0;
        this.button.textContent = "▶ play";
    }

    frame(before, clock) {
        this.go(clock);
        const end = Math.max(...this.views.map(view => view.motion.clocks));
        if (clock >= end) return this.stop();
        this.playing = requestAnimationFrame(now => {
            const { view } = this, span = view.max - view.min, next = clock + (now - before) / 1000 / PLAY_SECONDS * span;
            if (next > view.max) view.set(view.max - OVERLAP * span, view.max + (1 - OVERLAP) * span);
            this.frame(now, Math.min(next, end));
        });
    }
}
