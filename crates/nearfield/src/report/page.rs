//! The page: one file of HTML that is also well-formed XML, with everything in it.

use super::{
    chart::Figure,
    papers::papers,
    results::{Results, distinct},
    section::Section,
    table::Table,
};
use crate::bench::{Machine, Outcome, Record};

const CSS: &str = include_str!("page.css");
/// Tables of more rows are folded.
const LONG: usize = 30;

/// The page. `pictures` are the figures of all sections as SVG, in order.
pub(super) fn page(results: &Results, sections: &[Section], pictures: &[String]) -> String {
    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n");
    page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n";
    page += &format!("<title>Nearfield: measurements</title>\n<style>\n{CSS}</style>\n</head>\n<body>\n");
    page += "<h1>Nearfield: measurements</h1>\n";
    page += "<p>Finding every pair of particles closer than a cutoff, by every method there is here, and what it costs: \
             the experiments of papers A (Meneses et al., RT-core accelerated fixed-radius search) and B (Algis and \
             Bramas, ray tracing for interactions with cutoff) repeated on the machines below, and some more. The \
             papers' own values stand beside ours where the papers state them.</p>\n";
    page += &contents(sections);
    page += &machines(&results.records);
    page += &correctness(&results.records);
    let mut pictures = pictures.iter();
    for section in sections {
        page += &text_of(section, results, &mut pictures);
    }
    page + "</body>\n</html>\n"
}

fn contents(sections: &[Section]) -> String {
    let link = |s: &Section| format!("<a href=\"#{}\">{}</a>\n", s.suite, escape(s.title));
    format!("<nav>\n{}</nav>\n", sections.iter().map(link).collect::<String>())
}

fn machines(records: &[Record]) -> String {
    let all: Vec<&Record> = records.iter().collect();
    let rows: String = distinct(&all, |record| (record.device_name.as_str(), &record.machine))
        .into_iter()
        .map(|(device, machine)| {
            let cells = [device.to_owned(), describe(machine), machine.driver.clone().unwrap_or_default()];
            let cells = cells.into_iter().chain([machine.nearfield.clone()]);
            format!("<tr>{}</tr>\n", cells.map(|cell| format!("<td>{}</td>", escape(&cell))).collect::<String>())
        })
        .collect();
    format!(
        "<h2>Machines</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th>device</th><th>machine</th><th>NVIDIA \
         driver</th><th>Nearfield</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    )
}

fn describe(machine: &Machine) -> String {
    let cpu = machine.cpu.as_deref().unwrap_or("processor unknown");
    let memory =
        machine.memory.map_or(String::new(), |bytes| format!(", {:.0} GiB", bytes as f64 / (1u64 << 30) as f64));
    format!("{cpu}, {} cores{memory}, {}", machine.cores, machine.system)
}

/// Whether all methods found the same pairs.
fn correctness(records: &[Record]) -> String {
    let measured = records.iter().filter(|record| matches!(record.outcome, Outcome::Measured(_))).count();
    let wrong: Vec<String> = records
        .iter()
        .filter_map(|record| match &record.outcome {
            Outcome::Mismatch { pairs, expected } => Some((record, format!("{pairs} pairs instead of {expected}"))),
            Outcome::Failed { reason } => Some((record, reason.clone())),
            _ => None,
        })
        .map(|(record, what)| {
            let Record { suite, case, n, plan, device, .. } = record;
            let text = format!("{suite}, {case}, n = {n}, {} on {device}: {what}", plan.method);
            format!("<li>{}</li>\n", escape(&text))
        })
        .collect();
    if wrong.is_empty() {
        return format!(
            "<p>{measured} measurements. In each case, all methods on all devices found the same number of pairs.</p>\n"
        );
    }
    let count = wrong.len();
    format!(
        "<p><strong>{count} measurements failed or found other pairs than the rest:</strong></p>\n<ul>\n{}</ul>\n",
        wrong.concat()
    )
}

fn text_of<'a>(section: &Section, results: &Results, pictures: &mut impl Iterator<Item = &'a String>) -> String {
    let suite = section.suite;
    let mut text = format!("<h2 id=\"{suite}\">{}</h2>\n<p class=\"source\">{}</p>\n", section.title, suite.source());
    for paragraph in section.text.iter().filter(|paragraph| !paragraph.is_empty()) {
        text += &format!("<p>{}</p>\n", escape(paragraph));
    }
    let claims: String = papers()
        .claim
        .iter()
        .filter(|claim| claim.suite == suite.name())
        .map(|claim| {
            format!("<li>{} <span class=\"source\">({})</span></li>\n", escape(&claim.text), escape(&claim.source))
        })
        .collect();
    if !claims.is_empty() {
        text += &format!("<p>What the paper found:</p>\n<ul>\n{claims}</ul>\n");
    }
    for figure in &section.figures {
        if let Some(svg) = pictures.next() {
            text += &inline(figure, svg);
        }
    }
    text += &section.tables.iter().map(table).collect::<String>();
    text + &commands(section, results)
}

fn inline(figure: &Figure, svg: &str) -> String {
    let svg = svg.trim_start_matches(|c| c != '<').replacen("<svg ", "<svg role=\"img\" ", 1);
    let caption = escape(&figure.caption);
    let id = escape(&figure.id);
    format!("<figure id=\"figure-{id}\">\n{svg}<figcaption>{caption} ({id}.svg, {id}.png)</figcaption>\n</figure>\n")
}

fn table(table: &Table) -> String {
    let cell = |cell: &super::table::Cell| {
        let class = if cell.is_best { " class=\"best\"" } else { "" };
        let hint = if cell.hint.is_empty() { String::new() } else { format!(" title=\"{}\"", escape(&cell.hint)) };
        format!("<td{class}{hint}>{}</td>", escape(&cell.text))
    };
    let header: String = table.header.iter().map(|name| format!("<th>{}</th>", escape(name))).collect();
    let rows: String =
        table.rows.iter().map(|row| format!("<tr>{}</tr>\n", row.iter().map(cell).collect::<String>())).collect();
    let caption = escape(&table.caption);
    let body = format!("<thead><tr>{header}</tr></thead>\n<tbody>\n{rows}</tbody>\n");
    if table.rows.len() > LONG {
        let count = table.rows.len();
        let open = format!("<details><summary>{caption} ({count} rows)</summary>\n<div class=\"scroll\"><table>\n");
        return format!("{open}{body}</table></div></details>\n");
    }
    format!("<div class=\"scroll\"><table>\n<caption>{caption}</caption>\n{body}</table></div>\n")
}

/// How to repeat what is shown.
fn commands(section: &Section, results: &Results) -> String {
    let records = results.of(section.suite);
    let lines: String = distinct(&records, |record| (record.device.as_str(), record.quick))
        .into_iter()
        .map(|(device, quick)| {
            let quick = if quick { " --quick" } else { "" };
            format!("nearfield bench {}{quick} --device {device} -o out\n", section.suite)
        })
        .collect();
    format!("<p>To repeat it:</p>\n<pre>{}nearfield plot out</pre>\n", escape(&lines))
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
