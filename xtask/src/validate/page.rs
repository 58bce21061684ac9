//! The parts of the report: sections of figures and tables, as HTML and as CSV.

use std::fmt::Write as _;

use crate::plot::{Panels, Plot, escape};

/// A chapter of the report.
#[derive(Clone, Debug)]
pub struct Section {
    /// The anchor, which is also what `--only` calls it.
    pub id: &'static str,
    pub title: &'static str,
    /// What to see in it.
    pub lead: String,
    pub blocks: Vec<Block>,
}

/// What a section is made of.
#[derive(Clone, Debug)]
pub enum Block {
    Heading(String),
    Figure(Figure),
    Table(Table),
}

/// A plot with its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The stem of its files.
    pub name: String,
    pub plot: Plot,
    /// A sentence that says what to see, and how it was measured.
    pub caption: String,
}

/// Panels of named marks, with their caption.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The stem of its files.
    pub name: String,
    pub panels: Panels,
    /// What the marks are.
    pub caption: String,
}

/// Numbers in rows.
#[derive(Clone, Debug)]
pub struct Table {
    /// The stem of its file.
    pub name: String,
    pub caption: String,
    pub headers: Vec<String>,
    pub rows: Vec<Row>,
    /// Long tables are folded until somebody asks.
    pub folded: bool,
    /// Whether its cells are sentences, which run from the left and wrap, and not numbers.
    pub prose: bool,
    /// How many of its columns, from the first, are names; the others are numbers.
    pub names: usize,
}

/// One row of a table.
#[derive(Clone, Debug, Default)]
pub struct Row {
    pub cells: Vec<String>,
    pub tone: Tone,
}

/// How a row stands out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    #[default]
    Plain,
    Bad,
}

impl Row {
    pub fn of(cells: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { cells: cells.into_iter().map(Into::into).collect(), tone: Tone::Plain }
    }

    pub fn bad_if(mut self, bad: bool) -> Self {
        self.tone = if bad { Tone::Bad } else { Tone::Plain };
        self
    }
}

impl Table {
    pub fn new(name: &str, caption: &str, headers: &[&str], rows: Vec<Row>) -> Self {
        Self {
            name: name.to_owned(),
            caption: caption.to_owned(),
            headers: headers.iter().map(|h| (*h).to_owned()).collect(),
            rows,
            folded: false,
            prose: false,
            names: 1,
        }
    }

    pub fn folded(mut self) -> Self {
        self.folded = true;
        self
    }

    pub fn prose(mut self) -> Self {
        self.prose = true;
        self
    }

    pub fn with_names(mut self, columns: usize) -> Self {
        self.names = columns;
        self
    }

    fn csv(&self) -> String {
        let line = |cells: &[String]| cells.iter().map(|c| quoted(c)).collect::<Vec<_>>().join(",") + "\n";
        line(&self.headers) + &self.rows.iter().map(|row| line(&row.cells)).collect::<String>()
    }

    fn html(&self) -> String {
        let class = if self.prose { " class=\"prose\"" } else { "" };
        let name = |column: usize| if column < self.names { " class=\"name\"" } else { "" };
        let mut html = format!("<div class=\"scroll\"><table id=\"{}\"{class}>\n<thead><tr>", self.name);
        for (k, header) in self.headers.iter().enumerate() {
            let _ = write!(html, "<th{}>{}", name(k), escape(header));
        }
        html.push_str("</thead>\n<tbody>\n");
        for row in &self.rows {
            html.push_str(if row.tone == Tone::Bad { "<tr class=\"wrong\">" } else { "<tr>" });
            for (k, cell) in row.cells.iter().enumerate() {
                // On a telephone a row is a card, in which each number is told what it is.
                let of = self.headers.get(k).map_or("", String::as_str);
                let _ = write!(html, "<td{} data-of=\"{}\">{}", name(k), escape(of), escape(cell));
            }
            html.push('\n');
        }
        html.push_str("</tbody></table></div>\n");
        let link = format!("<a href=\"{0}.csv\">{0}.csv</a>", self.name);
        if self.folded {
            format!(
                "<details><summary>{} ({} rows)</summary>{html}<p>{link}</p></details>\n",
                prose(&self.caption),
                self.rows.len()
            )
        } else {
            format!("<p class=\"caption\">{} {link}</p>{html}", prose(&self.caption))
        }
    }
}

impl Figure {
    /// The points.
    fn csv(&self) -> String {
        let mut csv = format!("series,{},{}\n", quoted(&self.plot.x), quoted(&self.plot.y));
        for series in &self.plot.series {
            for [x, y] in &series.points {
                let _ = writeln!(csv, "{},{x:e},{y:e}", quoted(&series.name));
            }
        }
        csv
    }

    fn html(&self) -> String {
        format!(
            "<figure id=\"{0}\">{1}<figcaption>{2} <a href=\"{0}.csv\">{0}.csv</a></figcaption></figure>\n",
            self.name,
            self.plot.svg(),
            prose(&self.caption)
        )
    }
}

impl Drawing {
    /// The marks.
    pub fn csv(&self) -> String {
        let mut csv = "question,who,error,nanoseconds,disproved\n".to_owned();
        for panel in &self.panels.panels {
            for mark in &panel.marks {
                let (what, who) = (quoted(&panel.title), quoted(&mark.name));
                let _ = writeln!(csv, "{what},{who},{:e},{:e},{}", mark.error, mark.ns, mark.disproved);
            }
        }
        csv
    }

    pub fn html(&self) -> String {
        format!(
            "<figure id=\"{0}\" class=\"first\">{1}{2}<figcaption>{3} <a href=\"{0}.csv\">{0}.csv</a></figcaption></figure>\n",
            self.name,
            self.panels.svg(3, "wide"),
            self.panels.svg(2, "narrow"),
            prose(&self.caption)
        )
    }
}

impl Section {
    pub fn html(&self) -> String {
        let mut html =
            format!("<section id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n", self.id, escape(self.title), prose(&self.lead));
        // Figures in a row share a grid.
        let mut in_grid = false;
        for block in &self.blocks {
            let figure = matches!(block, Block::Figure(_));
            if figure != in_grid {
                html.push_str(if figure { "<div class=\"grid\">\n" } else { "</div>\n" });
                in_grid = figure;
            }
            match block {
                Block::Heading(text) => {
                    let _ = writeln!(html, "<h3>{}</h3>", escape(text));
                }
                Block::Figure(figure) => html.push_str(&figure.html()),
                Block::Table(table) => html.push_str(&table.html()),
            }
        }
        if in_grid {
            html.push_str("</div>\n");
        }
        html.push_str("</section>\n");
        html
    }

    /// Names and contents of the CSV files beside the page.
    pub fn files(&self) -> impl Iterator<Item = (String, String)> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Heading(_) => None,
            Block::Figure(figure) => Some((format!("{}.csv", figure.name), figure.csv())),
            Block::Table(table) => Some((format!("{}.csv", table.name), table.csv())),
        })
    }
}

/// A sentence for HTML; what stands between backticks is code.
pub fn prose(text: &str) -> String {
    let part = |(k, part): (usize, &str)| if k % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() };
    escape(text).split('`').enumerate().map(part).collect()
}

/// A field of CSV.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// An error as people read it.
pub fn error(value: f64) -> String {
    match value {
        _ if value.is_nan() => "–".to_owned(),
        0.0 => "0".to_owned(),
        _ => format!("{value:.1e}"),
    }
}
