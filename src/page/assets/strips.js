// Strip charts: one per channel, each stretch drawn from its lowest to its highest value.

const FINE_S = 60;
const COARSE_S = 300;
const COARSE_STRETCH_S = 0.2;
// Narrowest range of a strip in its unit: noise at rest is to look like noise.
const NARROWEST = { deg: 1, N: 2, "N m": 1, "m/s": 0.2 };
const FRAMES_KEPT = 300;

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Times and values of a chart, two points a stretch.
class Track {
  constructor(keepS) {
    this.keepS = keepS;
    this.x = [];
    this.y = [];
    this.stepS = 0;
  }

  push(t, low, high) {
    const last = this.last;
    if (last !== undefined && t <= last) return;
    const step = last === undefined ? 0 : t - last;
    this.last = t;
    if (this.stepS > 0 && step > 8 * this.stepS) {
      // A hole in the record is a hole in the line.
      this.x.push(t - this.stepS / 2);
      this.y.push(null);
    } else if (step > 0) {
      this.stepS = step;
    }
    const falls = (this.y.at(-1) ?? 0) > (low + high) / 2;
    // Side by side within the stretch, so that a slow curve is a curve and no stairs.
    const quarterS = this.stepS / 4;
    this.x.push(t - quarterS, t + quarterS);
    this.y.push(...(falls ? [high, low] : [low, high]));
    // Cut in bulk: a shift of every point a frame would cost more than the drawing.
    if (this.x.length > 256 && this.x[128] < t - this.keepS) {
      this.x.splice(0, 128);
      this.y.splice(0, 128);
    }
  }
}

class Strip {
  constructor(place) {
    this.box = document.createElement("div");
    this.box.className = "strip";
    this.head = document.createElement("p");
    this.head.className = "strip-head";
    this.plot = document.createElement("div");
    this.plot.setAttribute("role", "img");
    this.box.append(this.head, this.plot);
    place.append(this.box);
    this.clear();
  }

  clear() {
    this.fine = new Track(FINE_S);
    this.coarse = new Track(COARSE_S);
    this.under = null;
    this.value = null;
  }

  push(t, low, high) {
    this.fine.push(t, low, high);
    this.value = (low + high) / 2;
    const index = Math.floor(t / COARSE_STRETCH_S);
    if (this.under?.index === index) {
      this.under.low = Math.min(this.under.low, low);
      this.under.high = Math.max(this.under.high, high);
      return;
    }
    if (this.under) this.coarse.push(this.under.t, this.under.low, this.under.high);
    this.under = { index, t, low, high };
  }

  name({ quantity, unit }, colour) {
    if (this.quantity === quantity && this.unit === unit && this.colour === colour) return;
    Object.assign(this, { quantity, unit, colour });
    this.chart?.destroy();
    this.chart = null;
  }

  tell() {
    const shown = this.value === null ? "–" : this.value.toFixed(this.unit === "N" ? 2 : 3);
    this.head.textContent = `${this.quantity} ${shown} ${this.unit}`;
    this.plot.setAttribute("aria-label", `Strip chart of ${this.quantity}, now ${shown} ${this.unit}`);
  }

  draw(now, windowS, marks) {
    if (!this.quantity) return;
    this.view = { now, windowS, marks };
    const track = windowS > FINE_S ? this.coarse : this.fine;
    if (!this.chart) this.chart = this.make();
    // At once, not in a later turn: what a frame costs is to be known.
    this.chart.batch(() => this.chart.setData([track.x, track.y]));
  }

  make() {
    const narrowest = NARROWEST[this.unit] ?? 1;
    const axis = { stroke: () => css("--ink"), grid: { stroke: () => css("--grid"), width: 1 },
      ticks: { stroke: () => css("--grid"), width: 1 }, font: "12px sans-serif" };
    const range = (_chart, low, high) => {
      if (low === null || high === null) return [-narrowest / 2, narrowest / 2];
      const half = Math.max((1.15 * (high - low)) / 2, narrowest / 2);
      return [(low + high) / 2 - half, (low + high) / 2 + half];
    };
    return new uPlot({
      width: Math.max(200, this.plot.clientWidth),
      height: 150,
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, range: () => [this.view.now - this.view.windowS, this.view.now] },
        y: { range },
      },
      axes: [
        { ...axis, size: 26, values: (_chart, ticks) => ticks.map((t) => `${t} s`) },
        { ...axis, size: 56, space: 22 },
      ],
      series: [{}, { stroke: () => css(this.colour), width: 1.25, points: { show: false } }],
      hooks: { draw: [(chart) => this.drawMarks(chart)] },
    }, [this.fine.x, this.fine.y], this.plot);
  }

  drawMarks(chart) {
    const { ctx, bbox } = chart;
    ctx.save();
    ctx.strokeStyle = css("--mark");
    ctx.lineWidth = 2;
    ctx.setLineDash([6, 4]);
    for (const t of this.view.marks) {
      const x = chart.valToPos(t, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
  }

  fit() {
    this.chart?.setSize({ width: Math.max(200, this.plot.clientWidth), height: 150 });
  }
}

export class Strips {
  constructor(place) {
    this.place = place;
    this.all = [];
    this.now = 0;
    this.marks = [];
    this.shown = true;
    this.asked = false;
    this.frames = [];
    this.window = document.getElementById("window");
    this.window.addEventListener("change", () => this.ask());
    new ResizeObserver(() => this.all.forEach((strip) => strip.fit())).observe(place);
    document.addEventListener("theme", () => this.ask());
    setInterval(() => this.tell(), 500);
  }

  begin(past) {
    this.all.forEach((strip) => strip.clear());
    this.now = 0;
    this.push(past);
  }

  push({ t, c }) {
    c.forEach((stretches, k) => {
      const strip = (this.all[k] ??= new Strip(this.place));
      for (let i = 0; i < stretches.length; i += 3) {
        const at = t + stretches[i] / 1000;
        // A daemon that was started anew counts from zero again.
        if (at < this.now - COARSE_S) this.now = 0;
        strip.push(at, stretches[i + 1], stretches[i + 2]);
        this.now = Math.max(this.now, at);
      }
    });
    this.ask();
  }

  name(channels, recording) {
    const colours = ["--strip-1", "--strip-2", "--strip-3", "--strip-4"];
    channels.forEach((channel, k) => this.all[k]?.name(channel, colours[k % colours.length]));
    for (const gone of this.all.splice(channels.length)) gone.box.remove();
    this.recording = recording;
  }

  ask() {
    if (this.asked || !this.shown || document.hidden) return;
    this.asked = true;
    requestAnimationFrame((at) => this.draw(at));
  }

  draw(at) {
    this.asked = false;
    const begin = performance.now();
    const windowS = Number(this.window.value);
    for (const strip of this.all) strip.draw(this.now, windowS, this.marks);
    this.frames.push({ at, ms: performance.now() - begin });
    if (this.frames.length > FRAMES_KEPT) this.frames.shift();
  }

  // Values are told at a pace at which they can be read, by eye or aloud.
  tell() {
    for (const strip of this.all) if (strip.quantity) strip.tell();
    if (this.frames.length < 2) return;
    const ms = this.frames.map((frame) => frame.ms).sort((a, b) => a - b);
    const spanS = (this.frames.at(-1).at - this.frames[0].at) / 1000;
    const figures = document.getElementById("figures");
    const median = ms[ms.length >> 1];
    const worst = ms[Math.floor(0.99 * (ms.length - 1))];
    const perS = (this.frames.length - 1) / spanS;
    Object.assign(figures.dataset, { median: median.toFixed(2), worst: worst.toFixed(2),
      perS: perS.toFixed(1) });
    const bytesPerS = figures.dataset.bytesPerS;
    const flow = bytesPerS ? `, ${(bytesPerS / 1000).toFixed(1)} kB/s` : "";
    figures.textContent = `This page: ${perS.toFixed(0)} frames a second, ` +
      `${median.toFixed(1)} ms each to draw (99 %: ${worst.toFixed(1)} ms)${flow}.`;
  }
}
