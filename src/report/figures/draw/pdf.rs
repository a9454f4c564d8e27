//! A figure as PDF: paths and text, with the typeface embedded. Of SVG it knows what figures have: solid colours,
//! opacity, paths and text in one typeface.

use super::DrawError;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{
    CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap,
};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};
use resvg::tiny_skia::{PathSegment, Transform};
use resvg::usvg::{Fill, Group, Node, Paint, Path, Stroke, Text, Tree};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use ttf_parser::{Face, GlyphId};

/// Pixels of an SVG per point.
const POINTS_PER_PIXEL: f32 = 0.75;

const FONT: Name<'static> = Name(b"F");
const FONT_NAME: Name<'static> = Name(b"Arimo");
const IDENTITY: SystemInfo<'static> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// The numbers of the objects in the file.
const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const TYPE0: Ref = Ref::new(5);
const CID: Ref = Ref::new(6);
const DESCRIPTOR: Ref = Ref::new(7);
const FONT_FILE: Ref = Ref::new(8);
const TO_UNICODE: Ref = Ref::new(9);

/// What is drawn on the page, and what it needs.
struct Canvas {
    content: Content,
    /// Units of the typeface in its size.
    per_em: f32,
    /// Text of each glyph.
    glyphs: BTreeMap<u16, String>,
    /// Opacities in thousandths.
    opacities: BTreeSet<u16>,
}

/// A page of the size of the figure.
pub(super) fn page(tree: &Tree, typeface: &[u8]) -> Result<Vec<u8>, DrawError> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|x| x * POINTS_PER_PIXEL);
    let face = Face::parse(typeface, 0).map_err(std::io::Error::other)?;
    let mut canvas = Canvas {
        content: Content::new(),
        per_em: f32::from(face.units_per_em()),
        glyphs: BTreeMap::new(),
        opacities: BTreeSet::new(),
    };
    // From pixels down to points up.
    let scale = POINTS_PER_PIXEL;
    canvas
        .content
        .transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    canvas.group(tree.root(), 1.0);
    let mut pdf = Pdf::new();
    pdf.catalog(CATALOG).pages(PAGES);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut page = pdf.page(PAGE);
    page.parent(PAGES)
        .contents(CONTENT)
        .media_box(Rect::new(0.0, 0.0, width, height));
    let mut resources = page.resources();
    resources.fonts().pair(FONT, TYPE0);
    let mut states = resources.ext_g_states();
    for opacity in &canvas.opacities {
        let mut state = states
            .insert(Name(opacity_name(*opacity).as_bytes()))
            .start::<pdf_writer::writers::ExtGraphicsState<'_>>();
        let share = f32::from(*opacity) / 1000.0;
        state.non_stroking_alpha(share).stroking_alpha(share);
    }
    states.finish();
    resources.finish();
    page.finish();
    let content = deflated(&canvas.content.finish())?;
    pdf.stream(CONTENT, &content)
        .filter(pdf_writer::Filter::FlateDecode);
    embed(
        &mut pdf,
        &face,
        &canvas.glyphs,
        &deflated(typeface)?,
        typeface.len(),
    );
    Ok(pdf.finish())
}

fn opacity_name(thousandths: u16) -> String {
    format!("O{thousandths}")
}

fn deflated(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}

/// The typeface, the widths of its glyphs and the text of each.
fn embed(
    pdf: &mut Pdf,
    face: &Face<'_>,
    glyphs: &BTreeMap<u16, String>,
    file: &[u8],
    length: usize,
) {
    let per_em = 1000.0 / f32::from(face.units_per_em());
    let scaled = |units: i16| f32::from(units) * per_em;
    pdf.type0_font(TYPE0)
        .base_font(FONT_NAME)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(CID)
        .to_unicode(TO_UNICODE);
    let mut cid = pdf.cid_font(CID);
    cid.subtype(CidFontType::Type2)
        .base_font(FONT_NAME)
        .system_info(IDENTITY);
    cid.font_descriptor(DESCRIPTOR)
        .cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = cid.widths();
    for glyph in glyphs.keys() {
        let advance = face.glyph_hor_advance(GlyphId(*glyph)).unwrap_or(0);
        widths.consecutive(*glyph, [f32::from(advance) * per_em]);
    }
    widths.finish();
    cid.finish();
    let bounds = face.global_bounding_box();
    let [left, bottom] = [bounds.x_min, bounds.y_min].map(scaled);
    let [right, top] = [bounds.x_max, bounds.y_max].map(scaled);
    pdf.font_descriptor(DESCRIPTOR)
        .name(FONT_NAME)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(left, bottom, right, top))
        .italic_angle(0.0)
        .ascent(scaled(face.ascender()))
        .descent(scaled(face.descender()))
        .cap_height(scaled(face.capital_height().unwrap_or(0)))
        .stem_v(80.0)
        .font_file2(FONT_FILE);
    pdf.stream(FONT_FILE, file)
        .filter(pdf_writer::Filter::FlateDecode)
        .pair(Name(b"Length1"), length as i32);
    let mut texts = UnicodeCmap::new(Name(b"Arimo-UTF16"), IDENTITY);
    for (glyph, text) in glyphs {
        texts.pair_with_multiple(*glyph, text.chars());
    }
    pdf.cmap(TO_UNICODE, &texts.finish());
}

impl Canvas {
    fn group(&mut self, group: &Group, opacity: f32) {
        let opacity = opacity * group.opacity().get();
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner, opacity),
                Node::Path(path) => self.path(path, opacity),
                Node::Text(text) => self.text(text, opacity),
                Node::Image(_) => {}
            }
        }
    }

    fn with_opacity(&mut self, opacity: f32) {
        let thousandths = (1000.0 * opacity).round().clamp(0.0, 1000.0) as u16;
        self.opacities.insert(thousandths);
        self.content
            .set_parameters(Name(opacity_name(thousandths).as_bytes()));
    }

    fn path(&mut self, path: &Path, opacity: f32) {
        if !path.is_visible() {
            return;
        }
        let transform = path.abs_transform();
        let Some(data) = path.data().clone().transform(transform) else {
            return;
        };
        let fill = path.fill().and_then(|fill| self.fill(fill, opacity));
        let stroke = path
            .stroke()
            .and_then(|stroke| self.stroke(stroke, transform));
        for segment in data.segments() {
            match segment {
                PathSegment::MoveTo(p) => self.content.move_to(p.x, p.y),
                PathSegment::LineTo(p) => self.content.line_to(p.x, p.y),
                PathSegment::QuadTo(c, p) => self.content.cubic_to(c.x, c.y, c.x, c.y, p.x, p.y),
                PathSegment::CubicTo(a, b, p) => {
                    self.content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y)
                }
                PathSegment::Close => self.content.close_path(),
            };
        }
        match (fill, stroke) {
            (Some(()), Some(())) => self.content.fill_nonzero_and_stroke(),
            (Some(()), None) => self.content.fill_nonzero(),
            (None, Some(())) => self.content.stroke(),
            (None, None) => self.content.end_path(),
        };
    }

    fn fill(&mut self, fill: &Fill, opacity: f32) -> Option<()> {
        let Paint::Color(colour) = fill.paint() else {
            return None;
        };
        self.with_opacity(opacity * fill.opacity().get());
        let [r, g, b] = [colour.red, colour.green, colour.blue].map(|x| f32::from(x) / 255.0);
        self.content.set_fill_rgb(r, g, b);
        Some(())
    }

    fn stroke(&mut self, stroke: &Stroke, transform: Transform) -> Option<()> {
        let Paint::Color(colour) = stroke.paint() else {
            return None;
        };
        let [r, g, b] = [colour.red, colour.green, colour.blue].map(|x| f32::from(x) / 255.0);
        let (across, _) = transform.get_scale();
        self.content
            .set_stroke_rgb(r, g, b)
            .set_line_width(stroke.width().get() * across)
            .set_line_cap(LineCapStyle::ButtCap)
            .set_line_join(LineJoinStyle::RoundJoin);
        Some(())
    }

    fn text(&mut self, text: &Text, opacity: f32) {
        let whole = text.abs_transform();
        for span in text.layouted() {
            if span
                .fill
                .as_ref()
                .and_then(|fill| self.fill(fill, opacity))
                .is_none()
            {
                continue;
            }
            self.content.begin_text().set_font(FONT, 1.0);
            for glyph in &span.positioned_glyphs {
                let Ok(id) = u16::try_from(glyph.id.0) else {
                    continue;
                };
                // The outline is in units of the typeface, whose size here is one.
                let at = whole
                    .pre_concat(glyph.outline_transform())
                    .pre_scale(self.per_em, self.per_em);
                self.content
                    .set_text_matrix([at.sx, at.ky, at.kx, at.sy, at.tx, at.ty]);
                self.content.show(Str(&id.to_be_bytes()));
                self.glyphs.entry(id).or_insert_with(|| glyph.text.clone());
            }
            self.content.end_text();
        }
    }
}
