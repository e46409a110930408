//! From tokens to the pieces of entities: the syntax of a map, and the planes, but no meaning of names yet.

use std::borrow::Cow;

use glam::{DVec2, DVec3};
use planecut_kernel::HalfSpace;
use winnow::Parser;
use winnow::combinator::delimited;
use winnow::stream::Location;
use winnow::token::any;

use super::decimal::Decimal;
use super::error::{Found, Opening, SyntaxError};
use super::plane::{self, PlaneError, Point};
use super::texture::Alignment;
use super::token::{Input, Parsed, is_delimiter, name, number, peek, punctuation, quoted, word};

/// A piece of a map.
#[derive(Debug)]
pub(super) enum Event<'a> {
    /// An entity begins, with a brace at this offset.
    Begins(usize),
    /// A key of the entity, its offset, and its value.
    Key { offset: usize, key: Cow<'a, [u8]>, value: Cow<'a, [u8]> },
    /// A brush of the entity, or another primitive.
    Primitive(Primitive<'a>),
    /// The same outside any entity.
    Bare(Primitive<'a>),
    /// The entity ends.
    Ends,
}

/// What stands in braces of its own.
#[derive(Debug)]
pub(super) enum Primitive<'a> {
    Brush(Brush<'a>),
    LeftOut(LeftOut),
}

/// A brush.
#[derive(Debug)]
pub(super) struct Brush<'a> {
    /// Offset of its opening brace.
    offset: usize,
    /// Its line, once lines were [counted](Self::count_lines).
    pub(super) line: u32,
    pub(super) faces: Vec<Face<'a>>,
}

/// One face.
#[derive(Debug)]
pub(super) struct Face<'a> {
    /// Offset of its first parenthesis.
    offset: usize,
    /// Its line, once lines were counted, where its plane is not known to be right.
    pub(super) line: u32,
    pub(super) plane: Result<HalfSpace, PlaneError>,
    /// The plane as it is stated, where that is by four numbers.
    equation: Option<[Decimal; 4]>,
    pub(super) texture: Cow<'a, [u8]>,
    /// How the texture lies.
    pub(super) alignment: Alignment,
    /// The place from which the texture is laid.
    pub(super) origin: DVec3,
}

/// A primitive that is not read.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeftOut {
    /// Offset of its keyword.
    pub(super) offset: usize,
    /// Whether it is a curved patch.
    pub(super) is_patch: bool,
}

/// The next piece of a map, of an entity that has begun or outside any; `None` at the end of the text. An error may point to the
/// [`Entity`](Opening::Entity) that has begun.
pub(super) fn event<'a>(input: &mut Input<'a>, is_inside: bool) -> Parsed<Option<Event<'a>>> {
    if is_inside { inside(input).map(Some) } else { outside(input) }
}

fn outside<'a>(input: &mut Input<'a>) -> Parsed<Option<Event<'a>>> {
    version(input)?;
    if peek(input)?.is_none() {
        return Ok(None);
    }
    let opened = open_brace(input)?;
    if peek(input)?.is_some_and(|byte| byte == b'(' || byte.is_ascii_alphabetic()) {
        return primitive(input, opened).map(|primitive| Some(Event::Bare(primitive)));
    }
    Ok(Some(Event::Begins(opened)))
}

fn inside<'a>(input: &mut Input<'a>) -> Parsed<Event<'a>> {
    match peek(input)? {
        Some(b'"') => {
            let offset = input.current_token_start();
            let (key, value) = (quoted, quoted).parse_next(input)?;
            Ok(Event::Key { offset, key, value })
        }
        Some(b'{') => {
            let opened = open_brace(input)?;
            primitive(input, opened).map(Event::Primitive)
        }
        _ => {
            close_brace(input, Opening::Entity, "a key in quotes, `{` or `}`")?;
            Ok(Event::Ends)
        }
    }
}

impl Brush<'_> {
    /// Counts the lines that are asked for: its own, and those of faces whose planes may be wrong.
    pub(super) fn count_lines(&mut self, line_of: impl Fn(usize) -> u32) {
        self.line = line_of(self.offset);
        for face in self.faces.iter_mut().filter(|face| face.plane.is_err() || face.equation.is_some()) {
            face.line = line_of(face.offset);
        }
    }

    /// Whether a plane is stated by four numbers, which Doom 3 counts from the origin of the entity.
    pub(super) fn has_equations(&self) -> bool {
        self.faces.iter().any(|face| face.equation.is_some())
    }

    /// Moves what is stated relative to the origin of the entity: planes of four numbers, and textures on them.
    pub(super) fn put_at(&mut self, origin: &Point) {
        for face in &mut self.faces {
            if let Some(equation) = &face.equation {
                face.plane = plane::half_space_of(equation, origin);
                face.origin = DVec3::from_array(origin.map(Decimal::to_f64));
            }
        }
    }

    /// The brush with texts of its own.
    pub(super) fn into_owned(self) -> Brush<'static> {
        let owned = |face: Face<'_>| Face { texture: Cow::Owned(face.texture.into_owned()), ..face };
        Brush { offset: self.offset, line: self.line, faces: self.faces.into_iter().map(owned).collect() }
    }
}

/// Where nothing else is said: the origin of space.
pub(super) const NOWHERE: Point = [Decimal::Exact { mantissa: 0, places: 0 }; 3];

/// Three numbers between blanks.
pub(super) fn point_of(text: &[u8]) -> Option<Point> {
    let mut numbers = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).map(Decimal::parse);
    let point = [numbers.next()??, numbers.next()??, numbers.next()??];
    numbers.next().is_none().then_some(point)
}

/// The first line of a Doom 3 map, `Version 2`.
fn version(input: &mut Input<'_>) -> Parsed<()> {
    if peek(input)? == Some(b'V') && input.starts_with(b"Version") {
        (word, number).void().parse_next(input)?;
    }
    Ok(())
}

fn open_brace(input: &mut Input<'_>) -> Parsed<usize> {
    peek(input)?;
    let opened = input.current_token_start();
    punctuation(b'{', "`{`").parse_next(input)?;
    Ok(opened)
}

/// Takes `}`; an error says `expected` and where the brace was opened.
fn close_brace(input: &mut Input<'_>, opened: Opening, expected: &'static str) -> Parsed<()> {
    punctuation(b'}', expected).parse_next(input).map_err(|error| SyntaxError { opened: Some(opened), ..error })
}

/// What follows the opening brace of a brush, its closing brace included.
fn primitive<'a>(input: &mut Input<'a>, opened: usize) -> Parsed<Primitive<'a>> {
    let brush = |faces| Primitive::Brush(Brush { offset: opened, line: 0, faces });
    if !peek(input)?.is_some_and(|byte| byte.is_ascii_alphabetic()) {
        return faces(input, opened, Form::Points).map(brush);
    }
    let offset = input.current_token_start();
    let keyword = word(input)?;
    let form = if keyword.eq_ignore_ascii_case(b"brushDef") {
        Some(Form::PointsAndMatrix)
    } else if keyword.eq_ignore_ascii_case(b"brushDef3") {
        Some(Form::EquationAndMatrix)
    } else {
        None
    };
    let primitive = if let Some(form) = form {
        let inner = open_brace(input)?;
        brush(faces(input, inner, form)?)
    } else {
        skip_block(input)?;
        let is_patch = keyword.get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"patch"));
        Primitive::LeftOut(LeftOut { offset, is_patch })
    };
    close_brace(input, Opening::At(opened), "`}`")?;
    Ok(primitive)
}

/// Skips a block in braces, whatever it holds. Counts braces instead of recursing: depth costs nothing.
fn skip_block(input: &mut Input<'_>) -> Parsed<()> {
    let opened = open_brace(input)?;
    let mut depth = 1_usize;
    while depth > 0 {
        match peek(input)? {
            None => return close_brace(input, Opening::At(opened), "`}`"),
            Some(b'"') => quoted.void().parse_next(input)?,
            Some(byte) if is_delimiter(byte) => {
                any.void().parse_next(input)?;
                match byte {
                    b'{' => depth += 1,
                    b'}' => depth -= 1,
                    _ => {}
                }
            }
            Some(_) => word.void().parse_next(input)?,
        }
    }
    Ok(())
}

/// How a face states its plane, and whether a texture matrix follows.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// Three points.
    Points,
    /// Three points and a matrix (`brushDef`).
    PointsAndMatrix,
    /// Four numbers and a matrix (`brushDef3`).
    EquationAndMatrix,
}

/// Faces up to the closing brace, which is taken.
fn faces<'a>(input: &mut Input<'a>, opened: usize, form: Form) -> Parsed<Vec<Face<'a>>> {
    let mut faces = Vec::with_capacity(6);
    while peek(input)? == Some(b'(') {
        faces.push(face(input, form)?);
    }
    close_brace(input, Opening::At(opened), "`(` or `}`")?;
    Ok(faces)
}

fn face<'a>(input: &mut Input<'a>, form: Form) -> Parsed<Face<'a>> {
    let offset = input.current_token_start();
    let (plane, equation) = plane_of_face(input, form)?;
    let has_matrix = form != Form::Points;
    let matrix = if has_matrix { Some(matrix(input)?) } else { None };
    let texture = name(input)?;
    let (layout, axes) = if has_matrix {
        (Layout::Matrix, None)
    } else if peek(input)? == Some(b'[') {
        (Layout::Axes, Some((axis, axis).parse_next(input)?))
    } else {
        (Layout::Plain, None)
    };
    let values = values(input, offset, layout)?;
    let alignment = match (matrix, axes) {
        (Some((u, v)), _) => Alignment::Matrix { u, v },
        (None, Some((u, v))) => Alignment::Axes { u, v, scale: DVec2::new(values[1], values[2]) },
        (None, None) => {
            let [x, y, degrees, wide, high, ..] = values;
            Alignment::Plain { shift: DVec2::new(x, y), degrees, scale: DVec2::new(wide, high) }
        }
    };
    Ok(Face { offset, line: 0, plane, equation, texture, alignment, origin: DVec3::ZERO })
}

/// The plane of a face, and the four numbers that state it, where they do.
type StatedPlane = (Result<HalfSpace, PlaneError>, Option<[Decimal; 4]>);

fn plane_of_face(input: &mut Input<'_>, form: Form) -> Parsed<StatedPlane> {
    if form == Form::EquationAndMatrix {
        let equation = quadruple(input)?;
        return Ok((plane::half_space_of(&equation, &NOWHERE), Some(equation)));
    }
    let points: [Point; 3] = (triple, triple, triple).map(<[Point; 3]>::from).parse_next(input)?;
    Ok((plane::half_space(&points), None))
}

/// `( a b c d )`.
fn quadruple(input: &mut Input<'_>) -> Parsed<[Decimal; 4]> {
    let numbers = (number, number, number, number).map(<[Decimal; 4]>::from);
    delimited(punctuation(b'(', "`(`"), numbers, punctuation(b')', "`)`")).parse_next(input)
}

/// `( x y z )`.
fn triple(input: &mut Input<'_>) -> Parsed<Point> {
    let numbers = (number, number, number).map(Point::from);
    delimited(punctuation(b'(', "`(`"), numbers, punctuation(b')', "`)`")).parse_next(input)
}

/// `( ( a b c ) ( a b c ) )`.
fn matrix(input: &mut Input<'_>) -> Parsed<(DVec3, DVec3)> {
    let rows = (triple, triple).map(|rows: (Point, Point)| {
        let row = |[a, b, c]: Point| DVec3::new(a.to_f64(), b.to_f64(), c.to_f64());
        (row(rows.0), row(rows.1))
    });
    delimited(punctuation(b'(', "`(`"), rows, punctuation(b')', "`)`")).parse_next(input)
}

/// `[ x y z offset ]`.
fn axis(input: &mut Input<'_>) -> Parsed<(DVec3, f64)> {
    let numbers = (number, number, number, number);
    let numbers = numbers.map(|(x, y, z, offset)| (DVec3::new(x.to_f64(), y.to_f64(), z.to_f64()), offset.to_f64()));
    delimited(punctuation(b'[', "`[`"), numbers, punctuation(b']', "`]`")).parse_next(input)
}

/// How a face lays on its texture.
#[derive(Clone, Copy)]
enum Layout {
    /// By shift, rotation and scale.
    Plain,
    /// By two axes with their shifts, rotation and scale.
    Axes,
    /// By a matrix alone.
    Matrix,
}

impl Layout {
    /// How many values follow: those of the layout alone, with Hexen II's one, Quake 2's three, or Daikatana's six.
    fn counts(self) -> ([usize; 4], &'static str) {
        match self {
            Self::Plain => ([5, 6, 8, 11], "5, 6, 8 or 11"),
            Self::Axes => ([3, 4, 6, 9], "3, 4, 6 or 9"),
            Self::Matrix => ([0, 1, 3, 6], "0, 1, 3 or 6"),
        }
    }
}

/// The numbers at the end of a face, counted, and the first of them; `face` is where the face begins.
fn values(input: &mut Input<'_>, face: usize, layout: Layout) -> Parsed<[f64; 5]> {
    let mut first = [0.0; 5];
    let mut count = 0;
    while peek(input)?.is_some_and(|byte| !is_delimiter(byte)) {
        let number = number(input)?;
        if let Some(value) = first.get_mut(count) {
            *value = number.to_f64();
        }
        count += 1;
    }
    let (accepted, expected) = layout.counts();
    if accepted.contains(&count) {
        return Ok(first);
    }
    Err(SyntaxError { offset: face, found: Found::Values(count), expected, opened: None })
}
