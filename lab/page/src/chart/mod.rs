//! Figures as inline SVG that a style sheet colours.
//!
//! Alternatives: `plotters` writes fixed colours into every element, and no title, description or
//! classes. `charming` draws in the browser with a script. `poloto` is themed by CSS, but has no
//! title or description, no bars, bands or intervals, and does not thin points. This module needs
//! only axes, lines, bands, bars and marks. `maud` writes the markup.
//!
//! Positions inside the axes are percentages of a drawing area, so a figure is as wide as its page,
//! and its text has the same size on any screen. Lines and bands are paths in an area of 1000 by
//! 500 that is stretched over the drawing area.

pub mod scale;
mod thin;

use maud::{html, Markup, PreEscaped};
use scale::Scale;
use std::fmt::Write as _;

/// Number of columns of pixels; each column keeps its extremes.
const COLUMNS: usize = 900;
/// Most points of a curve that is no function of its x.
const POINTS: usize = 4000;
/// The area in which paths are drawn.
const AREA: [f64; 2] = [1000.0, 500.0];

/// One axis.
#[derive(Debug, Clone)]
pub struct Axis {
    /// The quantity of the axis, with its unit.
    pub label: String,
    /// The scale, from values to positions.
    pub scale: Scale,
}

/// A figure.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Unique on the page.
    id: String,
    /// Its name, also for a screen reader.
    title: String,
    /// What it shows, in words, for a screen reader.
    description: String,
    /// A sentence under it.
    caption: String,
    x: Axis,
    y: Axis,
    is_low: bool,
    layers: Vec<Markup>,
    keys: Vec<(String, String)>,
}

/// A number in a path or in per cent, with one digit.
fn short(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").map_or(text.clone(), str::to_owned);
    if text == "-0" {
        "0".to_owned()
    } else {
        text
    }
}

/// A share of the area in per cent.
fn percent(share: f64) -> String {
    let text = format!("{:.2}%", 100.0 * share.clamp(-10.0, 10.0));
    text.replace(".00%", "%")
}

impl Chart {
    /// An empty figure.
    #[must_use]
    pub fn new(id: &str, title: &str, description: &str, x: Axis, y: Axis) -> Self {
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            description: description.to_owned(),
            caption: String::new(),
            x,
            y,
            is_low: false,
            layers: Vec::new(),
            keys: Vec::new(),
        }
    }

    /// The same figure with a caption.
    #[must_use]
    pub fn caption(mut self, caption: &str) -> Self {
        caption.clone_into(&mut self.caption);
        self
    }

    /// A smaller height, for a figure among many.
    #[must_use]
    pub fn low(mut self) -> Self {
        self.is_low = true;
        self
    }

    /// An entry of the legend.
    #[must_use]
    pub fn key(mut self, class: &str, label: &str) -> Self {
        self.keys.push((class.to_owned(), label.to_owned()));
        self
    }

    /// Place of a point in the unit square, y upwards.
    fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x.scale.at(x)?, self.y.scale.at(y)?])
    }

    fn path(mut self, class: &str, lines: &[Vec<[f64; 2]>], closed: bool) -> Self {
        let mut path = String::new();
        for line in lines.iter().filter(|line| line.len() > 1) {
            for (k, [x, y]) in line.iter().enumerate() {
                path.push(if k == 0 { 'M' } else { 'L' });
                // Beyond the area only the direction counts.
                let y = (1.0 - y).clamp(-5.0, 6.0);
                let _ = write!(
                    path,
                    "{} {}",
                    short(AREA[0] * x.clamp(-5.0, 6.0)),
                    short(AREA[1] * y)
                );
            }
            if closed {
                path.push('Z');
            }
        }
        if !path.is_empty() {
            self.layers.push(html! {
                svg class="area" viewBox={ "0 0 " (AREA[0]) " " (AREA[1]) } preserveAspectRatio="none" width="100%" height="100%" {
                    path class=(class) d=(path) {}
                }
            });
        }
        self
    }

    /// A line through points with ascending x, within the axis; very many points are reduced to
    /// their extremes.
    #[must_use]
    pub fn line(self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.lines(class, &[points.into_iter().collect()])
    }

    /// A line with gaps: several runs in sequence.
    #[must_use]
    pub fn lines(self, class: &str, runs: &[Vec<[f64; 2]>]) -> Self {
        let columns = match self.is_low {
            // A figure among many is a third as wide.
            true => COLUMNS / 3,
            false => COLUMNS,
        };
        let run = |points: &Vec<[f64; 2]>| {
            let places = points.iter().filter_map(|p| self.place(*p));
            let inside = places.filter(|[x, _]| (-1e-9..=1.0 + 1e-9).contains(x));
            let points: Vec<[f64; 2]> = inside.collect();
            thin::columns(&points, columns)
        };
        let lines: Vec<Vec<[f64; 2]>> = runs.iter().map(run).collect();
        self.path(class, &lines, false)
    }

    /// A curve through points in any order; repeated points are drawn once.
    #[must_use]
    pub fn curve(self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points: Vec<[f64; 2]> = points.into_iter().filter_map(|p| self.place(p)).collect();
        let lines = thin::cells(&points, POINTS);
        self.path(class, &lines, false)
    }

    /// The area between two lines: points of x, lower and upper y.
    #[must_use]
    pub fn band(self, class: &str, points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for [x, low, high] in points {
            lower.extend(self.place([x, low]));
            upper.extend(self.place([x, high]));
        }
        upper.reverse();
        lower.append(&mut upper);
        self.path(class, &[lower], true)
    }

    /// A stretch of the x axis with a name.
    #[must_use]
    pub fn stretch(mut self, class: &str, label: &str, [from, to]: [f64; 2]) -> Self {
        if let (Some(from), Some(to)) = (self.x.scale.at(from), self.x.scale.at(to)) {
            self.layers.push(html! {
                rect class=(class) x=(percent(from)) y="0" width=(percent(to - from)) height="100%" {}
                text class="name" x=(percent(from)) dx="4" y="0" dy="13" { (label) }
            });
        }
        self
    }

    /// A horizontal line.
    #[must_use]
    pub fn level(mut self, class: &str, y: f64) -> Self {
        if let Some(y) = self.y.scale.at(y).filter(|y| (0.0..=1.0).contains(y)) {
            let y = percent(1.0 - y);
            self.layers
                .push(html! { line class=(class) x1="0" x2="100%" y1=(y) y2=(y) {} });
        }
        self
    }

    /// A vertical line.
    #[must_use]
    pub fn moment(mut self, class: &str, x: f64) -> Self {
        if let Some(x) = self.x.scale.at(x).filter(|x| (0.0..=1.0).contains(x)) {
            let x = percent(x);
            self.layers
                .push(html! { line class=(class) x1=(x) x2=(x) y1="0" y2="100%" {} });
        }
        self
    }

    /// A dot at each point, with its interval if there is one: x, y, lower and upper end.
    #[must_use]
    pub fn dots(mut self, class: &str, points: &[([f64; 2], Option<[f64; 2]>)]) -> Self {
        let mut marks = Vec::new();
        for (point, interval) in points {
            let Some([x, y]) = self.place(*point) else {
                continue;
            };
            let ends = interval.map(|ends| ends.map(|y| self.y.scale.at(y)));
            marks.push(html! {
                @if let Some([Some(low), Some(high)]) = ends {
                    line x1=(percent(x)) x2=(percent(x)) y1=(percent(1.0 - low)) y2=(percent(1.0 - high)) {}
                }
                circle cx=(percent(x)) cy=(percent(1.0 - y)) r="2.6" {}
            });
        }
        self.layers
            .push(html! { g class={ "dots " (class) } { @for mark in &marks { (mark) } } });
        self
    }

    /// A bar from zero for each point, with this width in units of x.
    #[must_use]
    pub fn bars(mut self, class: &str, width: f64, points: &[[f64; 2]]) -> Self {
        let Some(zero) = self.y.scale.at(0.0) else {
            return self;
        };
        let bar = |[x, y]: &[f64; 2]| {
            let [left, end] = self.place([x - 0.5 * width, *y])?;
            let right = self.x.scale.at(x + 0.5 * width)?;
            let (low, high) = (zero.min(end), zero.max(end));
            let below = if end < zero { " less" } else { "" };
            Some(html! {
                rect class={ (class) (below) } x=(percent(left)) y=(percent(1.0 - high))
                    width=(percent(right - left)) height=(percent(high - low)) {}
            })
        };
        let bars: Vec<Markup> = points.iter().filter_map(bar).collect();
        self.layers.push(html! { @for bar in &bars { (bar) } });
        self
    }

    fn axes(&self) -> Markup {
        let below = if self.is_low { 3 } else { 4 };
        html! {
            @for tick in self.y.scale.ticks(below) {
                line class="grid" x1="0" x2="100%" y1=(percent(1.0 - tick.at)) y2=(percent(1.0 - tick.at)) {}
                text class="tick" x="-6" y=(percent(1.0 - tick.at)) dy="4" text-anchor="end" { (tick.label) }
            }
            @for tick in self.x.scale.ticks(4) {
                line class="grid" x1=(percent(tick.at)) x2=(percent(tick.at)) y1="0" y2="100%" {}
                text class="tick" x=(percent(tick.at)) y="100%" dy="16" text-anchor="middle" { (tick.label) }
            }
            text class="axis" x="-48" y="-9" { (self.y.label) }
            text class="axis" x="100%" y="100%" dy="33" text-anchor="end" { (self.x.label) }
        }
    }

    fn inside(&self) -> Markup {
        html! {
            (self.axes())
            @for layer in &self.layers { (layer) }
            rect class="frame" x="0" y="0" width="100%" height="100%" {}
        }
    }

    /// The figure on a page.
    #[must_use]
    pub fn figure(&self) -> Markup {
        let id = &self.id;
        let height = if self.is_low { 130 } else { 280 };
        html! {
            figure class=(if self.is_low { "chart low" } else { "chart" }) tabindex="0" {
                (self.legend())
                div class="pad" {
                    svg xmlns="http://www.w3.org/2000/svg" role="img" width="100%" height=(height)
                        aria-labelledby={ (id) "-title " (id) "-desc" } {
                        title id={ (id) "-title" } { (self.title) }
                        desc id={ (id) "-desc" } { (self.description) }
                        (self.inside())
                    }
                }
                figcaption { b { (self.title) } @if !self.caption.is_empty() { ". " (self.caption) } }
            }
        }
    }

    fn legend(&self) -> Markup {
        html! {
            @if !self.keys.is_empty() {
                ul class="keys" {
                    @for (class, label) in &self.keys {
                        li {
                            svg aria-hidden="true" width="22" height="10" { line class=(class) x1="0" x2="22" y1="5" y2="5" {} }
                            " " (label)
                        }
                    }
                }
            }
        }
    }

    /// The figure as a separate SVG file.
    #[must_use]
    pub fn file(&self) -> String {
        let id = &self.id;
        let (mut x, mut y) = (70.0, 46.0);
        let mut keys = Vec::new();
        for (class, label) in &self.keys {
            let length = 54.0 + 7.5 * label.chars().count() as f64;
            if x + length > 940.0 {
                (x, y) = (70.0, y + 17.0);
            }
            keys.push(html! {
                line class=(class) x1=(x) x2=(x + 24.0) y1=(y) y2=(y) {}
                text class="key" x=(x + 30.0) y=(y + 4.0) { (label) }
            });
            x += length;
        }
        let below = y + 40.0;
        let drawn = html! {
            svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 960 520" width="960" height="520"
                aria-labelledby={ (id) "-title " (id) "-desc" } {
                title id={ (id) "-title" } { (self.title) }
                desc id={ (id) "-desc" } { (self.description) }
                style { (PreEscaped(crate::document::STYLE_OF_A_FIGURE)) }
                rect class="ground" width="960" height="520" {}
                text class="title" x="22" y="26" { (self.title) }
                @for key in &keys { (key) }
                svg x="70" y=(below) width="860" height=(466.0 - below) overflow="visible" { (self.inside()) }
            }
        };
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n",
            drawn.into_string()
        )
    }
}
