//! Queries out of tables, and answers into columns: CSV for programs that have a million rows, and for which JSON would
//! cost more than the answers.
//!
//! A template is a query in which `$name` stands for the cell of that column: bare for a number, between quotes for a
//! text. The first row of a table has the names. A row is filled into the template as text, so that a number is read
//! once, and all else is as for a line of JSON. One row is one line: a cell between quotes may have commas and doubled
//! quotes, and no line break.

use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};

/// A query with places for cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Template {
    /// The text before each place, the name of its column, and whether it is between quotes.
    places: Vec<(String, String, bool)>,
    /// The text after the last place.
    end: String,
}

impl Template {
    /// # Errors
    /// Where a `$` is not followed by a name, or nothing is to be filled in.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (mut places, mut before, mut is_quoted) = (Vec::new(), String::new(), false);
        let mut rest = text.trim().chars().peekable();
        while let Some(c) = rest.next() {
            match c {
                '$' => {
                    let mut name = String::new();
                    while let Some(c) = rest.next_if(|c| c.is_alphanumeric() || *c == '_') {
                        name.push(c);
                    }
                    if name.is_empty() {
                        return Err("a `$` of a template is followed by the name of a column".to_owned());
                    }
                    places.push((std::mem::take(&mut before), name, is_quoted));
                }
                '\\' if is_quoted => {
                    before.push(c);
                    before.extend(rest.next());
                }
                c => {
                    is_quoted ^= c == '"';
                    before.push(c);
                }
            }
        }
        if places.is_empty() {
            return Err("a template says by `$name` where the cell of the column `name` goes".to_owned());
        }
        Ok(Self { places, end: before })
    }

    /// For a table with this first row.
    ///
    /// # Errors
    /// Where the table lacks a column.
    pub fn bind(&self, header: &str) -> Result<Bound<'_>, String> {
        let names = cells(header)?;
        let column = |(_, name, _): &(String, String, bool)| {
            let found = names.iter().position(|column| column.trim() == name);
            found.ok_or_else(|| format!("the table has no column `{name}`; its columns are {}", names.join(", ")))
        };
        let columns = self.places.iter().map(column).collect::<Result<_, _>>()?;
        Ok(Bound { template: self, columns, count: names.len() })
    }
}

/// A template for a table of known columns.
#[derive(Clone, Debug)]
pub struct Bound<'t> {
    template: &'t Template,
    /// The column of each place.
    columns: Vec<usize>,
    /// How many columns there are.
    count: usize,
}

impl Bound<'_> {
    /// The query of a row.
    ///
    /// # Errors
    /// Where the row has more or fewer cells than the first, or a cell is no number where one is due.
    pub fn fill(&self, row: &[u8]) -> Result<Vec<u8>, Problem> {
        let wrong = |why: String| Problem::new(Kind::Parse, why);
        let row = std::str::from_utf8(row).map_err(|_| wrong("the row is not UTF-8".to_owned()))?;
        let cells = cells(row).map_err(wrong)?;
        if cells.len() != self.count {
            return Err(wrong(format!("the row has {} cells, and the first row {}", cells.len(), self.count)));
        }
        let mut query = Vec::with_capacity(256);
        for ((before, name, is_quoted), &column) in self.template.places.iter().zip(&self.columns) {
            query.extend_from_slice(before.as_bytes());
            let cell = &cells[column];
            if *is_quoted {
                let text = serde_json::to_string(cell).unwrap_or_default();
                query.extend_from_slice(&text.as_bytes()[1..text.len() - 1]);
            } else {
                query.extend_from_slice(number(cell.trim()).map_err(|why| wrong(why).at(name))?.as_bytes());
            }
        }
        query.extend_from_slice(self.template.end.as_bytes());
        Ok(query)
    }
}

/// A number as JSON has it: tables also have `+1`, `.5` and `1.`.
fn number(cell: &str) -> Result<Cow<'_, str>, String> {
    if serde_json::from_str::<serde_json::Number>(cell).is_ok() {
        return Ok(cell.into());
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(format!("{value:e}").into()),
        _ => Err(format!("{cell:?} is not a finite number")),
    }
}

/// The cells of a row.
fn cells(row: &str) -> Result<Vec<Cow<'_, str>>, String> {
    if !row.contains('"') {
        return Ok(row.split(',').map(Cow::from).collect());
    }
    let (mut cells, mut cell, mut is_open) = (Vec::new(), String::new(), false);
    let mut rest = row.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '"' if is_open && rest.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' => is_open = !is_open,
            ',' if !is_open => cells.push(Cow::from(std::mem::take(&mut cell))),
            c => cell.push(c),
        }
    }
    if is_open {
        return Err("a quote is not closed within its line".to_owned());
    }
    cells.push(cell.into());
    Ok(cells)
}

/// What of each answer is written, in this order.
#[derive(Debug)]
pub struct Columns {
    names: Vec<String>,
    /// Whether some answer had it.
    found: Vec<AtomicBool>,
}

impl Columns {
    #[must_use]
    pub fn new(names: &[String]) -> Self {
        let found = names.iter().map(|name| AtomicBool::new(matches!(name.as_str(), "id" | "error"))).collect();
        Self { names: names.to_vec(), found }
    }

    /// The first row.
    #[must_use]
    pub fn header(&self) -> String {
        self.names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",") + "\n"
    }

    /// The row of an answer, with empty cells for what the answer lacks. `id` is what the query calls itself, and
    /// `error` what is wrong with it.
    #[must_use]
    pub fn row(&self, id: &str, outcome: &Result<Answer, Problem>) -> Vec<u8> {
        let mut row = Vec::with_capacity(32 * self.names.len());
        for (k, (name, found)) in self.names.iter().zip(&self.found).enumerate() {
            if k > 0 {
                row.push(b',');
            }
            let cell = match (name.as_str(), outcome) {
                ("id", _) => Some(Cow::from(id)),
                ("error", Err(problem)) => Some(Cow::from(&problem.message)),
                (path, Ok(answer)) => answer_at(answer, path).map(Cow::from),
                (_, Err(_)) => None,
            };
            if let Some(cell) = cell {
                found.store(true, Ordering::Relaxed);
                row.extend_from_slice(quoted(&cell).as_bytes());
            }
        }
        row.push(b'\n');
        row
    }

    /// The columns that no answer had.
    pub fn missing(&self) -> impl Iterator<Item = &str> {
        let found = self.found.iter().map(|found| found.load(Ordering::Relaxed));
        self.names.iter().zip(found).filter(|(_, found)| !found).map(|(name, _)| name.as_str())
    }
}

/// The value of `name`, of `name.0` in a vector, or of `name.of` in an answer within an answer; empty for null.
fn answer_at(answer: &Answer, path: &str) -> Option<String> {
    let (name, rest) = path.split_once('.').map_or((path, None), |(name, rest)| (name, Some(rest)));
    match (answer.field(name)?, rest) {
        (Field::Null, _) => Some(String::new()),
        (Field::Text(text), None) => Some((*text).to_owned()),
        (field, None) => serde_json::to_string(field).ok(),
        (Field::Numbers(numbers), Some(index)) => {
            serde_json::to_string(numbers.get(index.parse::<usize>().ok()?)?).ok()
        }
        (Field::Answer(within), Some(rest)) => answer_at(within, rest),
        _ => None,
    }
}

/// A cell, between quotes where it needs them.
fn quoted(cell: &str) -> Cow<'_, str> {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\"")).into()
    } else {
        cell.into()
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec2;

    use super::*;

    #[test]
    fn a_row_is_filled_into_its_template() {
        let template = Template::parse(r#"{"id":"$name","r":$r,"x":[$x,0]}"#).expect("a template");
        let bound = template.bind("x,name,r").expect("its columns");
        let filled = |row: &str| bound.fill(row.as_bytes()).map(|text| String::from_utf8(text).expect("UTF-8"));
        assert_eq!(filled("1e-3,cup,2.5").as_deref(), Ok(r#"{"id":"cup","r":2.5,"x":[1e-3,0]}"#));
        let odd = filled("+.5,\"a \"\"b\"\", c\",1.").expect("quotes, and numbers as tables have them");
        assert_eq!(odd, r#"{"id":"a \"b\", c","r":1e0,"x":[5e-1,0]}"#);
        for row in ["1,cup", "1,cup,2,3", "1,cup,", "1,cup,NaN", "1,cup,1e999", "1,cup,2}", "1,\"cup,2"] {
            assert!(filled(row).is_err(), "{row}");
        }
        assert_eq!(filled("1,cup,x").map_err(|why| why.message), Err("r: \"x\" is not a finite number".to_owned()));
        assert!(template.bind("x,name").is_err_and(|why| why.contains("`r`")), "a column is missing");
        assert!(Template::parse(r#"{"r":1}"#).is_err() && Template::parse("$").is_err(), "nothing to fill in");
    }

    #[test]
    fn an_answer_is_a_row() {
        let double = |value| Field::number::<f64>(value);
        let answer = Answer::default()
            .with("distance", double(0.1))
            .with("point_a", Field::vector(DVec2::new(1.0, -2.5)))
            .with("normal", Field::Null);
        let names = ["id", "distance", "point_a.1", "normal", "point_a", "error", "lowr"].map(str::to_owned);
        let columns = Columns::new(&names);
        let row = |outcome: &Result<Answer, Problem>| String::from_utf8(columns.row("7", outcome)).expect("UTF-8");
        assert_eq!(columns.header(), "id,distance,point_a.1,normal,point_a,error,lowr\n");
        assert_eq!(row(&Ok(answer)), "7,0.1,-2.5,,\"[1.0,-2.5]\",,\n");
        assert_eq!(row(&Err(Problem::new(Kind::Parse, "a, b"))), "7,,,,,\"a, b\",\n");
        assert_eq!(columns.missing().collect::<Vec<_>>(), ["lowr"]);
    }
}
